// SPDX-License-Identifier: Apache-2.0
#include "vera/image/terminal_picture.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace vera {
namespace {

Image of_bytes(std::size_t width, std::size_t height, std::vector<std::uint8_t> samples) {
    return {width, height, std::move(samples)};
}

TEST(ShrunkImage, HasTheMeanLightOfEachPart) {
    const Image image = of_bytes(2, 2, {0, 0, 0, 255, 255, 255, 255, 0, 9, 0, 255, 9});
    // Half the light of white is shown as 188.
    const std::vector<std::uint8_t> expected = {188, 188, 188, 188, 188, 9};
    EXPECT_EQ(shrunk_image(image, 1, 2).samples, of_bytes(1, 2, expected).samples);
    EXPECT_EQ(shrunk_image(image, 2, 2).samples, image.samples);
    EXPECT_EQ(shrunk_image(image, 50, 50).samples, image.samples);
}

TEST(ShrunkImage, LimitsFloatsAndTakesWhatIsNoNumberForDark) {
    Image image = {3, 1, std::vector<float>{1e30F, -1, 0.5F, 0, 0, 0, NAN, 1, INFINITY}};
    const std::vector<std::uint8_t> expected = {255, 0, 188, 0, 0, 0, 0, 255, 255};
    EXPECT_EQ(shrunk_image(image, 3, 1).samples, of_bytes(3, 1, expected).samples);
}

TEST(FittedSize, KeepsTheShapeAndIsNeverLarger) {
    const Image image = of_bytes(400, 100, {});
    EXPECT_EQ(fitted_size(image, 80, 60), (PictureSize{80, 20}));
    EXPECT_EQ(fitted_size(image, 800, 10), (PictureSize{40, 10}));
    EXPECT_EQ(fitted_size(image, 800, 600), (PictureSize{400, 100}));
    EXPECT_EQ(fitted_size(of_bytes(1000, 1, {}), 80, 60), (PictureSize{80, 1}));
}

TEST(HalfBlocks, ShowTwoRowsALineAndRepeatNoColour) {
    const Image image = of_bytes(2, 3, {1, 2, 3, 1, 2, 3, 4, 5, 6, 7, 8, 9, 0, 0, 0, 255, 0, 0});
    EXPECT_EQ(
        half_blocks(image, TerminalColors::rgb24),
        "\x1b[38;2;1;2;3m\x1b[48;2;4;5;6m\u2580\x1b[48;2;7;8;9m\u2580\x1b[0m\n"
        "\x1b[38;2;0;0;0m\x1b[49m\u2580\x1b[38;2;255;0;0m\u2580\x1b[0m\n");
}

TEST(HalfBlocks, TakeColoursThatNobodyChanges) {
    const Image image = of_bytes(2, 2, {0, 0, 0, 255, 255, 255, 255, 0, 0, 8, 8, 8});
    EXPECT_EQ(
        half_blocks(image, TerminalColors::indexed256),
        "\x1b[38;5;16m\x1b[48;5;196m\u2580\x1b[38;5;231m\x1b[48;5;232m\u2580\x1b[0m\n");
}

TEST(KittyGraphics, SendsTheSamplesInPieces) {
    EXPECT_EQ(
        kitty_graphics(of_bytes(1, 1, {'M', 'a', 'n'})),
        "\x1b_Ga=T,f=24,q=2,s=1,v=1,m=0;TWFu\x1b\\\n");
    // 3073 pixels of 3 bytes are 12292 letters: three pieces and 4 letters.
    const std::string text =
        kitty_graphics(of_bytes(3073, 1, std::vector<std::uint8_t>(3 * 3073, 0)));
    std::size_t pieces = 0;
    for (std::size_t at = text.find("\x1b_G"); at != std::string::npos;
         at = text.find("\x1b_G", at + 1))
        ++pieces;
    EXPECT_EQ(pieces, 4U);
    EXPECT_NE(text.find("\x1b_Gm=1;AAAA"), std::string::npos);
    EXPECT_TRUE(text.ends_with("\x1b_Gm=0;AAAA\x1b\\\n"));
}

} // namespace
} // namespace vera
