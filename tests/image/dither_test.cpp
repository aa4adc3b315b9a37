// SPDX-License-Identifier: Apache-2.0
#include "vera/image/dither.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr Dither all_dithers[] = {Dither::none, Dither::floyd_steinberg, Dither::blue_noise};

std::vector<std::uint8_t> reduced(
    const std::vector<std::uint8_t>& samples,
    std::size_t width,
    const Palette& palette,
    Dither dither) {
    ColorReducer reducer(palette, dither, width);
    std::vector<std::uint8_t> numbers(samples.size() / 3);
    for (std::size_t first = 0; first < numbers.size(); first += width)
        reducer.reduce(
            std::span(samples).subspan(3 * first, 3 * width),
            std::span(numbers).subspan(first, width));
    return numbers;
}

std::vector<std::uint8_t> one_color(Rgb8 color, std::size_t pixels) {
    std::vector<std::uint8_t> samples;
    for (std::size_t i = 0; i < pixels; ++i)
        samples.insert(samples.end(), color.begin(), color.end());
    return samples;
}

TEST(ColorReducer, LeavesColoursOfThePaletteAsTheyAre) {
    const Palette palette = *named_palette("ega16");
    std::mt19937 random(2);
    std::vector<std::uint8_t> samples;
    std::vector<std::uint8_t> expected;
    for (int i = 0; i < 37 * 20; ++i) {
        expected.push_back(static_cast<std::uint8_t>(random() % palette.size()));
        const Rgb8 color = palette[expected.back()];
        samples.insert(samples.end(), color.begin(), color.end());
    }
    for (const Dither dither : all_dithers)
        EXPECT_EQ(reduced(samples, 37, palette, dither), expected) << static_cast<int>(dither);
}

TEST(ColorReducer, TakesTheNearestColourWithoutDithering) {
    const Palette palette = *named_palette("web216");
    std::vector<Oklab> table;
    for (const Rgb8 color : palette)
        table.push_back(oklab(color));
    std::mt19937 random(3);
    std::vector<std::uint8_t> samples;
    for (int i = 0; i < 3 * 500; ++i)
        samples.push_back(static_cast<std::uint8_t>(random() % 256));
    const auto numbers = reduced(samples, 50, palette, Dither::none);
    for (std::size_t i = 0; i < numbers.size(); ++i)
        ASSERT_EQ(
            numbers[i],
            nearest_color(
                table, oklab(Rgb8{samples[3 * i], samples[3 * i + 1], samples[3 * i + 2]})));
}

TEST(ColorReducer, KeepsTheLightOfAnAreaThatThePaletteCanMix) {
    constexpr std::size_t side = 64;
    for (const Dither dither : {Dither::floyd_steinberg, Dither::blue_noise})
        for (const Rgb8 color : {Rgb8{30, 30, 30}, Rgb8{200, 120, 60}, Rgb8{128, 128, 255}}) {
            const Palette palette = *named_palette("rgb8");
            const auto numbers = reduced(one_color(color, side * side), side, palette, dither);
            LinearRgb sum = {};
            for (const std::uint8_t number : numbers)
                for (std::size_t c = 0; c < 3; ++c)
                    sum[c] += linear_light(palette[number])[c];
            for (std::size_t c = 0; c < 3; ++c)
                EXPECT_NEAR(sum[c] / (side * side), linear_light(color)[c], 0.025)
                    << static_cast<int>(dither) << ' ' << c;
        }
}

TEST(ColorReducer, GoesToAndFroWithFloydAndSteinberg) {
    // Black and white from the definition by hand, on the second row from the right.
    const Palette palette = *named_palette("bw");
    const auto numbers =
        reduced(one_color({188, 188, 188}, 8), 4, palette, Dither::floyd_steinberg);
    double errors[2][6] = {};
    const double wanted = linear_light({188, 188, 188})[0];
    std::vector<std::uint8_t> expected(8);
    for (int y = 0; y < 2; ++y)
        for (int i = 0; i < 4; ++i) {
            const int x = y == 0 ? i : 3 - i;
            const int step = y == 0 ? 1 : -1;
            const double value = std::clamp(wanted + errors[y][x + 1], -0.05, 1.05);
            // Half the way from black to white as displayed.
            const int number = value > 0.214 ? 1 : 0;
            const double error = value - number;
            expected[static_cast<std::size_t>(4 * y + x)] = static_cast<std::uint8_t>(number);
            errors[y][x + 1 + step] += error * 7 / 16;
            if (y == 0) {
                errors[1][x + 1 - step] += error * 3 / 16;
                errors[1][x + 1] += error * 5 / 16;
                errors[1][x + 1 + step] += error * 1 / 16;
            }
        }
    EXPECT_EQ(numbers, expected);
}

TEST(BlueNoise, HasEachRankOnceAndLittleOfLowFrequencies) {
    using detail::blue_noise;
    using detail::blue_noise_side;
    std::vector<std::uint16_t> ranks(blue_noise.begin(), blue_noise.end());
    std::sort(ranks.begin(), ranks.end());
    for (std::size_t i = 0; i < ranks.size(); ++i)
        ASSERT_EQ(ranks[i], i);

    // Means of squares of 8 x 8 differ by far less than those of ranks in a random order would.
    const auto deviation = [](const auto& mask) {
        double sum = 0;
        for (std::size_t square = 0; square < 64; ++square) {
            double mean = 0;
            for (std::size_t i = 0; i < 64; ++i)
                mean += mask[(square / 8 * 8 + i / 8) * blue_noise_side + square % 8 * 8 + i % 8];
            sum += (mean / 64 - 2047.5) * (mean / 64 - 2047.5);
        }
        return std::sqrt(sum / 64);
    };
    std::shuffle(ranks.begin(), ranks.end(), std::mt19937(1));
    EXPECT_LT(deviation(blue_noise), 0.35 * deviation(ranks));
}

} // namespace
} // namespace vera
