// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/without_cracks.h"

#include <cstddef>
#include <random>
#include <vector>

#include "visible/painted_color.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::doubled_area;
using testing::turns_about;

/// A square of 10 pixels with a crack into it from below, which is that wide there.
BorderRing cracked_square(double width) {
    return {{0, 0}, {10, 0}, {10, 10}, {5 + width, 10}, {5, 3}, {5, 10}, {0, 10}};
}

BorderRing begun_at(const BorderRing& ring, std::size_t first) {
    BorderRing other;
    for (std::size_t i = 0; i < ring.size(); ++i)
        other.push_back(ring[(first + i) % ring.size()]);
    return other;
}

bool has(const BorderRing& ring, DrawingPoint place) {
    for (const BorderPoint& point : ring)
        if (point == place)
            return true;
    return false;
}

TEST(WithoutCracks, CoversWhatLiesInCracksWhereverTheRingBegins) {
    for (const double width : {0.0, 0.004, 0.015}) {
        const BorderRing ring = cracked_square(width);
        for (std::size_t first = 0; first < ring.size(); ++first) {
            const BorderRing kept = without_cracks(begun_at(ring, first));
            EXPECT_FALSE(has(kept, {5, 3})) << width << " " << first;
            EXPECT_NEAR(doubled_area(std::vector<BorderRing>{kept}), 200, 1e-12);
        }
    }
}

TEST(WithoutCracks, TakesAwayCracksWithCornersOnBothSides) {
    const BorderRing ring = {
        {0, 0}, {10, 0}, {10, 10}, {5.01, 10}, {5, 6}, {4, 3}, {5, 6.01}, {5, 10}, {0, 10}};
    for (std::size_t first = 0; first < ring.size(); ++first) {
        const BorderRing kept = without_cracks(begun_at(ring, first));
        EXPECT_EQ(turns_about(std::vector<BorderRing>{kept}, {4.5, 4.505}), 1);
        EXPECT_FALSE(has(kept, {5, 6}));
    }
}

TEST(WithoutCracks, TakesAwayCracksWithBluntEnds) {
    const BorderRing ring = {
        {0, 0}, {10, 0}, {10, 10}, {5.01, 10}, {5.01, 3}, {5, 3}, {5, 10}, {0, 10}};
    for (std::size_t first = 0; first < ring.size(); ++first) {
        const BorderRing kept = without_cracks(begun_at(ring, first));
        EXPECT_EQ(turns_about(std::vector<BorderRing>{kept}, {5.005, 5}), 1) << first;
        EXPECT_FALSE(has(kept, {5, 3}) || has(kept, {5.01, 3})) << first;
    }
    // A hole, blunt at both ends and with corners between them, as two treads of a stair leave it.
    // Its short sides are parts of curves.
    const BorderRing hole = {
        {{0, 0.001}, 2}, {0, 0}, {18, -0.009}, {{22.3, 0.005}, 7}, {22.3, 0.006}, {18, 0.004}};
    for (std::size_t first = 0; first < hole.size(); ++first)
        EXPECT_TRUE(without_cracks(begun_at(hole, first)).empty()) << first;
}

TEST(WithoutCracks, LeavesWhatIsWiderAndWhatLiesAlongCurves) {
    const BorderRing wide = cracked_square(0.05);
    EXPECT_EQ(without_cracks(wide).size(), wide.size());
    BorderRing curved = cracked_square(0.01);
    curved[4].curve = 0;
    EXPECT_EQ(without_cracks(curved).size(), curved.size());
}

TEST(WithoutCracks, LeavesNothingOfWaysToAndFro) {
    EXPECT_TRUE(without_cracks({{0, 0}, {4, 0}, {9, 0}, {2, 0}}).empty());
    EXPECT_TRUE(without_cracks({}).empty());
}

/// Between whole numbers of few values, ways that lead to and fro do so exactly.
TEST(WithoutCracks, ChangesNoArea) {
    std::mt19937 random(7);
    int shorter = 0;
    for (int round = 0; round < 20000; ++round) {
        BorderRing ring(1 + random() % 9);
        for (BorderPoint& point : ring) {
            point.x = static_cast<double>(random() % 3);
            point.y = static_cast<double>(random() % 3);
        }
        const BorderRing kept = without_cracks(ring);
        EXPECT_EQ(
            doubled_area(std::vector<BorderRing>{kept}),
            doubled_area(std::vector<BorderRing>{ring}));
        shorter += kept.size() < ring.size() ? 1 : 0;
    }
    EXPECT_GT(shorter, 10000);
}

} // namespace
} // namespace vera
