// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/sure_nearness.h"

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

/// Of few values, so that many are as near as each other.
SureNearness any_nearness(std::mt19937& random, std::uint32_t values) {
    SureNearness nearness;
    const double margin = static_cast<double>(random() % 3) / 2;
    for (std::size_t i = 0; i < 2; ++i) {
        const auto near = static_cast<double>(random() % values);
        nearness.least[i] = near - margin;
        nearness.most[i] = near + margin;
    }
    return nearness;
}

TEST(SureNearness, OfManyTellsWhatEachTellsOfEachOther) {
    std::mt19937 random(1975);
    HiddenOfMany many;
    std::size_t hidden = 0;
    std::size_t seen = 0;
    for (std::uint32_t round = 0; round < 3000; ++round) {
        std::vector<SureNearness> all(random() % 40);
        for (SureNearness& one : all)
            one = any_nearness(random, 2 + round % 30);
        const std::vector<std::uint8_t>& found = many.hidden(all);
        ASSERT_EQ(found.size(), all.size());
        for (std::size_t i = 0; i < all.size(); ++i) {
            const bool expected = std::any_of(
                all.begin(), all.end(), [&](const SureNearness& one) { return one.hides(all[i]); });
            ASSERT_EQ(found[i] != 0, expected) << "round " << round;
            ++(expected ? hidden : seen);
        }
    }
    EXPECT_GT(hidden, 1000U);
    EXPECT_GT(seen, 1000U);
}

/// As the triangles of an outline that crosses itself lie in one plane, a hundred thousand deep.
TEST(SureNearness, OfManyInOnePlaneTakesFewSteps) {
    for (const std::size_t count : {10U, 1000U, 100'000U}) {
        const std::vector<SureNearness> all(count, SureNearness{{1, 1}, {3, 3}});
        HiddenOfMany many;
        const std::vector<std::uint8_t>& found = many.hidden(all);
        EXPECT_EQ(std::count(found.begin(), found.end(), 1), 0);
        EXPECT_LE(many.steps(), 60 * count);
    }
}

} // namespace
} // namespace vera
