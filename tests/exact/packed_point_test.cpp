// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/packed_point.h"

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "exact/few_points.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

/// Many are equal, and some denominators are as long as any.
std::vector<RationalPoint> crossings(std::size_t rounds) {
    std::mt19937_64 random(1);
    std::vector<RationalPoint> points = {{}, {{screen_size, screen_size}}};
    for (std::size_t i = 0; i < rounds; ++i) {
        const ScreenPoint a = testing::few_point(random);
        const ScreenPoint b = testing::few_point(random);
        const ScreenPoint p = testing::few_point(random);
        const ScreenPoint q = testing::few_point(random);
        if (cross(step(a, b), step(p, q)) == 0)
            continue;
        const SegmentPlace place = crossing_place(a, b, p, q);
        if (place.numerator >= 0 && place.numerator <= place.denominator)
            points.push_back(point_at(a, b, place));
    }
    return points;
}

TEST(PackedPoint, IsUnpackedAsItWas) {
    std::int64_t longest = 0;
    for (const RationalPoint& point : crossings(20'000)) {
        const PackedPoint packed = point;
        ASSERT_EQ(RationalPoint(packed), point);
        EXPECT_EQ(packed.x(), point.x());
        EXPECT_EQ(packed.y(), point.y());
        longest = std::max(longest, point.denominator);
    }
    EXPECT_GT(longest, std::int64_t{1} << 43U);
    EXPECT_EQ(sizeof(PackedPoint), 24U);
    EXPECT_EQ(RationalPoint(PackedPoint{}), RationalPoint{});
}

TEST(PackedPoint, HasRoomForThePictureAndTakesNothingThatItHasNoRoomFor) {
    // More than any point of the picture has: a fraction of the longest denominator beside the
    // largest coordinates.
    constexpr std::int64_t longest = (std::int64_t{1} << 48) - 1;
    constexpr std::int32_t largest = (1 << 24) - 1;
    const RationalPoint last = {{largest, largest}, longest - 1, longest - 1, longest};
    EXPECT_EQ(RationalPoint(PackedPoint(last)), last);
    const std::array wrong = {
        RationalPoint{{-1, 0}},
        RationalPoint{{0, -1}},
        RationalPoint{{largest + 1, 0}},
        RationalPoint{{0, largest + 1}},
        RationalPoint{{0, 0}, -1, 0, 1},
        RationalPoint{{0, 0}, 0, -1, 1},
        RationalPoint{{0, 0}, 0, 0, longest + 1}};
    for (const RationalPoint& point : wrong)
        EXPECT_DEATH(PackedPoint{point}, "point.whole.x");
}

TEST(PackedPoint, EqualsAndHashesAsThePointsDo) {
    const std::vector<RationalPoint> points = crossings(1200);
    std::size_t equal = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const PackedPoint a = points[i];
            const PackedPoint b = points[j];
            ASSERT_EQ(a == b, points[i] == points[j]);
            ASSERT_EQ(hash_of(a) == hash_of(b), points[i] == points[j]); // of so few points
            equal += a == b ? 1 : 0;
        }
    EXPECT_GT(equal, 100U);
}

} // namespace
} // namespace vera
