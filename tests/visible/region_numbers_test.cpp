// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/region_numbers.h"

#include <algorithm>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(RegionNumbers, AreThoseOfAllRegionsInAscendingOrder) {
    std::mt19937 random(21);
    for (int round = 0; round < 300; ++round) {
        const auto below = [&](std::uint32_t limit) {
            return static_cast<std::uint32_t>(random() % limit);
        };
        const std::uint32_t sources = 1 + below(4);
        const LightSet sets = 1 + below(40);
        const std::uint32_t count = below(100);
        RegionNumbers numbers;
        std::set<VisibleMap::Region> added;
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t source = 2 * below(sources);
            const VisibleMap::Region region = {source, below(sets)};
            numbers.add(region);
            added.insert(region);
        }
        const std::vector<VisibleMap::Region> expected(added.begin(), added.end());
        ASSERT_EQ(numbers.numbered(), expected);
        for (std::uint32_t i = 0; i < expected.size(); ++i)
            ASSERT_EQ(numbers.number(expected[i]), i);
    }
}

/// As on a floor below the shadows of many lights. Looking through all of a face's sets for each of
/// them takes minutes.
TEST(RegionNumbers, OfOneFaceInVeryManySetsOfLightsAreFoundInTheirStride) {
    constexpr std::uint32_t count = 400'000;
    RegionNumbers numbers;
    for (LightSet unlit = 0; unlit < count; ++unlit)
        numbers.add({3, unlit});
    const std::vector<VisibleMap::Region> all = numbers.numbered();
    EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
    for (std::uint32_t i = 0; i < all.size(); ++i)
        ASSERT_EQ(numbers.number(all[i]), i);
}

} // namespace
} // namespace vera
