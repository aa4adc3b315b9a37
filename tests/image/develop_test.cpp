// SPDX-License-Identifier: Apache-2.0
#include "vera/image/develop.h"
#include "vera/math/elementary.h"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

TEST(Develop, RoundsToTheNearestByteAndClamps) {
    Image image = blank_image(4, 1, SampleType::integer8);
    const double infinity = std::numeric_limits<double>::infinity();
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();
    const std::vector<Color> colors = {
        {0, 1, 0.5},
        {-1, 2, -0.0},
        {infinity, -infinity, not_a_number},
        {0.49 / 255, 0.51 / 255, 254.5 / 255}};
    develop(colors, image, 0, 0);
    EXPECT_THAT(
        std::get<std::vector<std::uint8_t>>(image.samples),
        ElementsAre(0, 255, 128, 0, 255, 0, 255, 0, 0, 0, 1, 255));
}

TEST(Develop, RoundsToTheNearestOf65536AndClamps) {
    Image image = blank_image(2, 1, SampleType::integer16);
    develop(std::vector<Color>{{0, 1, 0.5}, {-1, 2, 1.4 / 65535}}, image, 0, 0);
    EXPECT_THAT(
        std::get<std::vector<std::uint16_t>>(image.samples),
        ElementsAre(0, 65535, 32768, 0, 65535, 1));
}

TEST(Develop, RoundsAsTheDefinitionNextToEveryHalf) {
    Image image = blank_image(1, 1, SampleType::integer8);
    const auto& samples = std::get<std::vector<std::uint8_t>>(image.samples);
    for (int i = 0; i < 255; ++i) {
        double value = (i + 0.5) / 255;
        for (int step = 0; step < 4; ++step)
            value = std::nextafter(value, 2);
        for (int step = 0; step < 9; ++step, value = std::nextafter(value, -1)) {
            develop(std::vector<Color>{{value, 0, 0}}, image, 0, 0);
            ASSERT_EQ(samples[0], std::lround(255 * value)) << i << ' ' << step;
        }
    }
}

TEST(Develop, MakesFloatsOfTheSrgbCurveToTheBit) {
    std::mt19937 random(1988);
    std::vector<Color> colors;
    const double special[] = {
        0,
        -0.0,
        0.04045,
        std::nextafter(0.04045, 1.0),
        1,
        -1,
        1e-30,
        0.5,
        2,
        16,
        1000,
        1080,
        1e10,
        std::ldexp(1.0, -4),
        0.999,
        1.001,
        -0.5,
        -3};
    for (const double value : special)
        colors.push_back({value, std::nextafter(value, -1e300), std::nextafter(value, 1e300)});
    std::uniform_real_distribution<double> usual(0, 1.2);
    std::uniform_real_distribution<double> exponent(-20, 12);
    for (int i = 0; i < 100'000; ++i)
        colors.push_back(
            {usual(random), std::exp2(exponent(random)), std::floor(256 * usual(random)) / 255});

    Image image = blank_image(colors.size(), 1, SampleType::float32);
    develop(colors, image, 0, 0);
    const auto& samples = std::get<std::vector<float>>(image.samples);
    for (std::size_t i = 0; i < colors.size(); ++i) {
        ASSERT_EQ(samples[3 * i], static_cast<float>(srgb_decoded(colors[i].r))) << colors[i].r;
        ASSERT_EQ(samples[3 * i + 1], static_cast<float>(srgb_decoded(colors[i].g)));
        ASSERT_EQ(samples[3 * i + 2], static_cast<float>(srgb_decoded(colors[i].b)));
    }
}

TEST(Develop, WritesOnlyItsOwnPixels) {
    Image image = blank_image(4, 3, SampleType::integer8);
    develop(std::vector<Color>{{1, 0, 0}, {0, 1, 0}}, image, 1, 2);
    std::vector<std::uint8_t> expected(36);
    expected[3 * 9] = 255;
    expected[3 * 10 + 1] = 255;
    EXPECT_EQ(std::get<std::vector<std::uint8_t>>(image.samples), expected);
}

TEST(BlankImage, SaysHowMuchMemoryIsMissing) {
    try {
        blank_image(std::size_t{1} << 31, std::size_t{1} << 31, SampleType::float32);
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(
            error.what(),
            HasSubstr("a picture of 2147483648 x 2147483648 pixels takes "
                      "51539607552.0 GiB of memory, of which "));
        EXPECT_THAT(
            error.what(), HasSubstr(" GiB are free; make it smaller or choose a format of 8 bits"));
    }
    try {
        blank_image(std::size_t{1} << 31, std::size_t{1} << 31, SampleType::integer8);
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), EndsWith("; make it smaller"));
    }
}

TEST(BlankImage, DoesNotBelieveASizeThatOverflows) {
    const std::size_t huge = std::numeric_limits<std::size_t>::max();
    EXPECT_THROW(blank_image(huge, huge, SampleType::integer8), std::runtime_error);
    EXPECT_THROW(blank_image(huge / 3 + 1, 1, SampleType::integer8), std::runtime_error);
    EXPECT_THROW(blank_image(1, huge / 2, SampleType::integer16), std::runtime_error);
}

} // namespace
} // namespace vera
