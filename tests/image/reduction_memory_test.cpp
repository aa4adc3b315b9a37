// SPDX-License-Identifier: Apache-2.0
// A program of its own, since it counts every byte that is allocated.
#include "vera/base/output_file.h"
#include "vera/base/parallel.h"
#include "vera/image/compressed_raster.h"
#include "vera/image/converted_image.h"
#include "vera/image/dither.h"
#include "vera/image/image_file.h"
#include "vera/image/indexed_file.h"

#include "base/counted_memory.h"
#include "base/scratch_folder.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(ColourReduction, OfACompressedRasterTakesOneRowOfTilesAndNotThePicture) {
    constexpr std::size_t width = 1500;
    constexpr std::size_t height = 3000;
    const ScratchFolder folder;
    const std::string name = folder.path() / "a";
    {
        Image image = blank_image(width, height, SampleType::integer8);
        auto& samples = std::get<std::vector<std::uint8_t>>(image.samples);
        for (std::size_t i = 0; i < samples.size(); ++i)
            samples[i] = static_cast<std::uint8_t>(i / 3 % width / 7 + i / (3 * width) / 40);
        OutputFile file(name);
        write_compressed_raster(image, file, {}, {.tile_side = 64});
        file.commit();
    }
    const ThreadLimit limit(1);
    const testing::MemoryWatch watch;
    {
        const auto bytes = file_bytes(name);
        const CompressedRaster raster(bytes, name);
        ColorHistogram histogram;
        histogram.add(raster);
        ColorReducer reducer(optimal_palette(histogram, 16), Dither::floyd_steinberg, width);
        PictureRows rows(raster);
        const IndexedPicture picture = {
            width, height, reducer.palette(), [&](std::span<std::uint8_t> numbers) {
                reducer.reduce(rows.next(), numbers);
            }};
        OutputFile file(name);
        write_indexed_png(picture, file);
        file.commit();
    }
    const std::size_t expanded = 3 * width * height;
    const std::size_t histogram_bytes = (std::size_t{1} << 16) * 32;
    const std::size_t band = 3 * width * 64;
    EXPECT_LT(watch.most_bytes(), histogram_bytes + 4 * band + 1000000);
    EXPECT_LT(watch.most_bytes(), expanded / 3);
}

} // namespace
} // namespace vera
