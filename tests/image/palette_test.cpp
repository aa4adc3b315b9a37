// SPDX-License-Identifier: Apache-2.0
#include "vera/base/diagnostic.h"
#include "vera/image/palette.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(OklabColor, HasTheValuesOfItsDefinition) {
    const Oklab white = oklab(Rgb8{255, 255, 255});
    EXPECT_NEAR(white.lightness, 1, 1e-6);
    EXPECT_NEAR(white.a, 0, 1e-6);
    EXPECT_NEAR(white.b, 0, 1e-6);
    const Oklab red = oklab(Rgb8{255, 0, 0});
    EXPECT_NEAR(red.lightness, 0.627955, 1e-5);
    EXPECT_NEAR(red.a, 0.224863, 1e-5);
    EXPECT_NEAR(red.b, 0.125846, 1e-5);
    EXPECT_EQ(oklab(Rgb8{0, 0, 0}).lightness, 0);
}

TEST(OklabColor, ComesBackToEveryByte) {
    for (int r = 0; r < 256; r += 5)
        for (int g = 0; g < 256; g += 15)
            for (int b = 0; b < 256; b += 17) {
                const Rgb8 color = {
                    static_cast<std::uint8_t>(r),
                    static_cast<std::uint8_t>(g),
                    static_cast<std::uint8_t>(b)};
                ASSERT_EQ(rgb8(oklab(color)), color);
            }
}

TEST(NamedPalette, HasTheColoursThatItsNameSays) {
    const std::pair<const char*, std::size_t> sizes[] = {
        {"bw", 2}, {"rgb8", 8}, {"ega16", 16}, {"web216", 216}, {"terminal256", 256}};
    for (const auto& [name, size] : sizes) {
        const auto palette = named_palette(name);
        ASSERT_TRUE(palette) << name;
        EXPECT_EQ(palette->size(), size) << name;
        EXPECT_THAT(palette_names(), testing::HasSubstr(name));
        EXPECT_NE(std::count(palette->begin(), palette->end(), Rgb8{255, 255, 255}), 0) << name;
    }
    EXPECT_EQ((*named_palette("terminal256"))[16 + 36 * 1 + 6 * 2 + 5], (Rgb8{95, 135, 255}));
    EXPECT_EQ((*named_palette("terminal256"))[255], (Rgb8{238, 238, 238}));
    EXPECT_FALSE(named_palette("vga"));
}

TEST(PaletteFromText, ReadsColoursAndTellsOfEveryWrongLine) {
    EXPECT_EQ(
        palette_from_text("; ours\n#ff8000\n\n  #00Ff7f ; green\r\n#000000", "p"),
        (Palette{{255, 128, 0}, {0, 255, 127}, {0, 0, 0}}));
    try {
        palette_from_text("#ff8000\nred\n#12345\n#1234567\n", "p");
        FAIL();
    } catch (const InputError& error) {
        ASSERT_EQ(error.diagnostics().size(), 3U);
        EXPECT_EQ(
            to_text(error.diagnostics()[0]),
            "p:2:1: error: expected a colour, found 'red'\n"
            "  write one of #rrggbb a line, as in #ff8000\n");
    }
    EXPECT_THROW(palette_from_text("; nothing\n", "p"), InputError);
    std::string long_text;
    for (int i = 0; i < 257; ++i)
        long_text += "#000000\n";
    EXPECT_THROW(palette_from_text(long_text, "p"), InputError);
}

ColorHistogram histogram_of(const std::vector<Rgb8>& colors) {
    ColorHistogram histogram;
    for (const Rgb8 color : colors)
        histogram.add(color);
    return histogram;
}

TEST(OptimalPalette, HasExactlyTheColoursOfAPictureOfFew) {
    const std::vector<Rgb8> few = {{0, 0, 0}, {20, 20, 90}, {200, 30, 30}, {255, 255, 255}};
    Palette palette = optimal_palette(histogram_of(few), 16);
    EXPECT_EQ(palette.front(), few.front());
    std::sort(palette.begin(), palette.end());
    EXPECT_EQ(palette, few);
}

TEST(OptimalPalette, DoesNotDependOnTheOrderOfPixels) {
    std::mt19937 random(4);
    std::vector<Rgb8> colors;
    for (int i = 0; i < 3000; ++i)
        colors.push_back(
            {static_cast<std::uint8_t>(random() % 256),
             static_cast<std::uint8_t>(random() % 64),
             static_cast<std::uint8_t>(random() % 128)});
    const Palette palette = optimal_palette(histogram_of(colors), 20);
    EXPECT_EQ(palette.size(), 20U);
    std::shuffle(colors.begin(), colors.end(), random);
    EXPECT_EQ(optimal_palette(histogram_of(colors), 20), palette);
}

/// The mean squared distance of colours from the nearest of a palette.
double error_of(const Palette& palette, const std::vector<Rgb8>& colors) {
    std::vector<Oklab> table;
    for (const Rgb8 color : palette)
        table.push_back(oklab(color));
    double sum = 0;
    for (const Rgb8 color : colors) {
        const Oklab wanted = oklab(color);
        sum += squared_distance(table[nearest_color(table, wanted)], wanted);
    }
    return sum / static_cast<double>(colors.size());
}

TEST(OptimalPalette, IsNearThatOfTryingAllPairs) {
    std::mt19937 random(9);
    for (int round = 0; round < 20; ++round) {
        // Two clouds of a few colours each.
        std::vector<Rgb8> colors;
        for (int i = 0; i < 14; ++i) {
            const int from = i % 2 == 0 ? 20 : 150;
            colors.push_back(
                {static_cast<std::uint8_t>(from + static_cast<int>(random() % 60)),
                 static_cast<std::uint8_t>(from + static_cast<int>(random() % 60)),
                 static_cast<std::uint8_t>(40 + random() % 60)});
        }
        double least = 1e9;
        for (const Rgb8 a : colors)
            for (const Rgb8 b : colors)
                least = std::min(least, error_of({a, b}, colors));
        EXPECT_LE(error_of(optimal_palette(histogram_of(colors), 2), colors), 1.02 * least);
    }
}

} // namespace
} // namespace vera
