// SPDX-License-Identifier: Apache-2.0
#include "vera/image/image_difference.h"

#include <cstdint>
#include <random>

#include <gtest/gtest.h>

namespace vera {
namespace {

Image grey(const std::vector<std::uint8_t>& levels) {
    std::vector<std::uint8_t> samples;
    for (const std::uint8_t level : levels)
        samples.insert(samples.end(), 3, level);
    return {levels.size(), 1, samples};
}

const std::vector<std::uint8_t>& samples(const ImageDifference& difference) {
    return std::get<std::vector<std::uint8_t>>(difference.image.samples);
}

TEST(ImageDifference, OfAPictureAndItselfIsNone) {
    const ImageDifference none = difference(grey({0, 7, 255}), grey({0, 7, 255}));
    EXPECT_EQ(none.factor, 1);
    EXPECT_EQ(none.changed_pixels, 0U);
    EXPECT_EQ(none.largest, 0);
    EXPECT_EQ(none.mean, 0);
    EXPECT_EQ(samples(none), std::vector<std::uint8_t>(9, 0));
}

TEST(ImageDifference, IsAmplifiedAsFarAsItCanBeShown) {
    EXPECT_EQ(difference(grey({0, 100}), grey({1, 100})).factor, 16);
    EXPECT_EQ(difference(grey({0}), grey({15})).factor, 16);
    EXPECT_EQ(difference(grey({0}), grey({16})).factor, 8);
    EXPECT_EQ(difference(grey({60}), grey({20})).factor, 4);
    EXPECT_EQ(difference(grey({0}), grey({128})).factor, 1);
    EXPECT_EQ(samples(difference(grey({60}), grey({20}))), std::vector<std::uint8_t>(3, 160));
}

TEST(ImageDifference, IsTheSameInBothDirectionsAndCountsPixels) {
    std::mt19937 random(3);
    for (int round = 0; round < 50; ++round) {
        std::vector<std::uint8_t> first;
        std::vector<std::uint8_t> second;
        std::size_t changed = 0;
        int largest = 0;
        for (int i = 0; i < 30; ++i) {
            first.push_back(static_cast<std::uint8_t>(random() % 4 * 85));
            second.push_back(static_cast<std::uint8_t>(random() % 4 * 85));
            changed += first.back() != second.back() ? 1 : 0;
            largest = std::max(largest, std::abs(first.back() - second.back()));
        }
        const ImageDifference there = difference(grey(first), grey(second));
        const ImageDifference back = difference(grey(second), grey(first));
        EXPECT_EQ(samples(there), samples(back));
        EXPECT_EQ(there.changed_pixels, changed);
        EXPECT_EQ(there.largest, largest);
    }
}

} // namespace
} // namespace vera
