// SPDX-License-Identifier: Apache-2.0
// A program of its own, since it counts every byte that is allocated.
#include "vera/base/output_file.h"
#include "vera/base/parallel.h"
#include "vera/image/compressed_raster.h"
#include "vera/image/converted_image.h"
#include "vera/image/dither.h"
#include "vera/image/image_file.h"
#include "vera/image/indexed_file.h"

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <new>

#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

namespace {

std::atomic<std::size_t> taken = 0;
std::atomic<std::size_t> most_taken = 0;

} // namespace

// Not inlined: the compiler would see that what new gives was not made by new.
[[gnu::noinline]] void* operator new(std::size_t size) {
    void* memory = std::malloc(size);
    if (memory == nullptr)
        throw std::bad_alloc();
    const std::size_t now = taken += malloc_usable_size(memory);
    std::size_t most = most_taken;
    while (now > most && !most_taken.compare_exchange_weak(most, now)) {
    }
    return memory;
}

[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    try {
        return operator new(size);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}

[[gnu::noinline]] void operator delete(void* memory) noexcept {
    if (memory != nullptr)
        taken -= malloc_usable_size(memory);
    std::free(memory);
}

void operator delete(void* memory, std::size_t /*size*/) noexcept {
    operator delete(memory);
}

namespace vera {
namespace {

TEST(ColourReduction, OfACompressedRasterTakesOneRowOfTilesAndNotThePicture) {
    constexpr std::size_t width = 1500;
    constexpr std::size_t height = 3000;
    std::string name = (std::filesystem::temp_directory_path() / "vera-memory-XXXXXX").native();
    close(mkstemp(name.data()));
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
    const std::size_t before = taken;
    most_taken = before;
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
    EXPECT_LT(most_taken - before, histogram_bytes + 4 * band + 1000000);
    EXPECT_LT(most_taken - before, expanded / 3);
    std::filesystem::remove(name);
}

} // namespace
} // namespace vera
