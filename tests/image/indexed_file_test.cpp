// SPDX-License-Identifier: Apache-2.0
#include "vera/base/output_file.h"
#include "vera/image/image_file.h"
#include "vera/image/indexed_file.h"

#include <filesystem>
#include <stdexcept>

#include "base/scratch_folder.h"
#include <gif_lib.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

namespace fs = std::filesystem;

class IndexedFile : public testing::Test {
protected:
    ScratchFolder scratch;
    fs::path folder = scratch.path();
};

std::uint8_t number_at(std::size_t x, std::size_t y, std::size_t colors, std::size_t shift) {
    return static_cast<std::uint8_t>((x * x + 3 * y + shift) % colors);
}

IndexedPicture pattern(std::size_t colors, std::size_t shift = 0) {
    IndexedPicture picture = {.width = 37, .height = 21};
    for (std::size_t i = 0; i < colors; ++i)
        picture.palette.push_back(
            {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(255 - i), 7});
    picture.next_row = [=, y = std::size_t{0}](std::span<std::uint8_t> numbers) mutable {
        for (std::size_t x = 0; x < numbers.size(); ++x)
            numbers[x] = number_at(x, y, colors, shift);
        ++y;
    };
    return picture;
}

TEST_F(IndexedFile, ComesBackFromPngWithAnyNumberOfColours) {
    for (const std::size_t colors : {1U, 2U, 3U, 4U, 5U, 16U, 17U, 256U}) {
        OutputFile file(folder / "a.png");
        const IndexedPicture picture = pattern(colors);
        write_indexed_png(picture, file, {{"Software", "vera"}});
        file.commit();
        const Image image = read_image(folder / "a.png");
        const auto& samples = std::get<std::vector<std::uint8_t>>(image.samples);
        ASSERT_EQ(samples.size(), 3U * 37 * 21);
        for (std::size_t i = 0; i < samples.size() / 3; ++i) {
            const Rgb8 color = picture.palette[number_at(i % 37, i / 37, colors, 0)];
            ASSERT_EQ((Rgb8{samples[3 * i], samples[3 * i + 1], samples[3 * i + 2]}), color);
        }
    }
}

TEST_F(IndexedFile, ComesBackFromGifWithAllItsPictures) {
    for (const std::size_t colors : {1U, 2U, 5U, 256U}) {
        const IndexedPicture pictures[] = {pattern(colors), pattern(colors, 1), pattern(colors, 2)};
        OutputFile file(folder / "a.gif");
        write_gif(pictures, file, 7);
        file.commit();
        int error = 0;
        GifFileType* gif = DGifOpenFileName((folder / "a.gif").c_str(), &error);
        ASSERT_NE(gif, nullptr);
        ASSERT_EQ(DGifSlurp(gif), GIF_OK);
        ASSERT_EQ(gif->ImageCount, 3);
        for (std::size_t frame = 0; frame < 3; ++frame) {
            GraphicsControlBlock control = {};
            ASSERT_EQ(DGifSavedExtensionToGCB(gif, static_cast<int>(frame), &control), GIF_OK);
            EXPECT_EQ(control.DelayTime, 7);
            for (std::size_t i = 0; i < 37U * 21; ++i) {
                const std::uint8_t number = gif->SavedImages[frame].RasterBits[i];
                ASSERT_EQ(number, number_at(i % 37, i / 37, colors, frame));
                ASSERT_EQ(gif->SColorMap->Colors[number].Green, 255 - number);
            }
        }
        DGifCloseFile(gif, nullptr);
    }
}

TEST_F(IndexedFile, PassesOnWhatTheRowsThrow) {
    IndexedPicture picture = pattern(4);
    picture.next_row = [](std::span<std::uint8_t>) { throw std::out_of_range("no row"); };
    {
        OutputFile png(folder / "a.png");
        EXPECT_THROW(write_indexed_png(picture, png), std::out_of_range);
        OutputFile gif(folder / "a.gif");
        EXPECT_THROW(write_gif({&picture, 1}, gif), std::out_of_range);
    }
    EXPECT_TRUE(fs::is_empty(folder));
}

} // namespace
} // namespace vera
