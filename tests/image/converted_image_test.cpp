// SPDX-License-Identifier: Apache-2.0
#include "vera/base/output_file.h"
#include "vera/image/converted_image.h"
#include "vera/image/image_file.h"

#include "base/scratch_folder.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

Image all_bytes() {
    Image image = blank_image(16, 16, SampleType::integer8);
    auto& samples = std::get<std::vector<std::uint8_t>>(image.samples);
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = static_cast<std::uint8_t>(i / 3 + 85 * (i % 3));
    return image;
}

TEST(ConvertedImage, ComesBackFromEveryTypeToTheByte) {
    const Image image = all_bytes();
    for (const SampleType type :
         {SampleType::integer8, SampleType::integer16, SampleType::float32}) {
        const Image there = converted_image(image, type);
        EXPECT_EQ(sample_type(there), type);
        EXPECT_EQ(converted_image(there, SampleType::integer8).samples, image.samples);
    }
}

TEST(ConvertedImage, StretchesBytesToSixteenBits) {
    const Image image = all_bytes();
    const Image wide = converted_image(image, SampleType::integer16);
    for (std::size_t i = 0; i < 3U * 16 * 16; ++i)
        ASSERT_EQ(
            std::get<std::vector<std::uint16_t>>(wide.samples)[i],
            257 * std::get<std::vector<std::uint8_t>>(image.samples)[i]);
}

TEST(ConvertedImage, PutsTheFactorOnTheLight) {
    Image light = blank_image(1, 1, SampleType::float32);
    light.samples = std::vector<float>{0.125F, 0.25F, 3};
    EXPECT_EQ(
        std::get<std::vector<float>>(converted_image(light, SampleType::float32, 2).samples)[0],
        0.25F);
    const Image shown = converted_image(light, SampleType::integer8, 2);
    // sRGB of 0.25 and 0.5.
    EXPECT_EQ(shown.samples, (decltype(shown.samples)(std::vector<std::uint8_t>{137, 188, 255})));
}

TEST(PictureRows, AreThoseOfThePictureAndOfItsRaster) {
    const ScratchFolder folder;
    const std::string name = folder.path() / "a";
    for (const SampleType type : {SampleType::integer8, SampleType::integer16}) {
        const Image image = converted_image(all_bytes(), type);
        {
            OutputFile file(name);
            write_compressed_raster(image, file, {}, {.tile_side = 5});
            file.commit();
        }
        const auto bytes = file_bytes(name);
        const CompressedRaster raster(bytes, "a");
        PictureRows from_image(image);
        PictureRows from_raster(raster);
        PictureRows moved = from_raster; // must not point into the one it came from
        const auto expected = std::get<std::vector<std::uint8_t>>(all_bytes().samples);
        for (std::size_t y = 0; y < 16; ++y) {
            const auto wanted = std::span(expected).subspan(48 * y, 48);
            for (PictureRows* rows : {&from_image, &from_raster, &moved}) {
                const auto row = rows->next();
                ASSERT_TRUE(std::equal(row.begin(), row.end(), wanted.begin(), wanted.end())) << y;
            }
        }
    }
}

} // namespace
} // namespace vera
