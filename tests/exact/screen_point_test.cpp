// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/screen_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>

#include "exact/few_points.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::few_point;

TEST(ScreenPoint, CrossingsLieOnBothSegmentsToTheLastBit) {
    std::mt19937_64 random(1);
    int crossings = 0;
    for (int i = 0; i < 200'000; ++i) {
        const ScreenPoint a = few_point(random);
        const ScreenPoint b = few_point(random);
        const ScreenPoint p = few_point(random);
        const ScreenPoint q = few_point(random);
        const std::int64_t side_a = orientation(p, q, a);
        const std::int64_t side_b = orientation(p, q, b);
        const std::int64_t side_p = orientation(a, b, p);
        const std::int64_t side_q = orientation(a, b, q);
        if (sign(side_a) * sign(side_b) >= 0 || sign(side_p) * sign(side_q) >= 0)
            continue;
        ++crossings;
        const SegmentPlace on_first = crossing_place(a, b, p, q);
        const SegmentPlace on_second = crossing_place(p, q, a, b);
        const RationalPoint point = point_at(a, b, on_first);
        EXPECT_EQ(point, point_at(p, q, on_second));
        EXPECT_EQ(point, point_at(b, a, crossing_place(b, a, q, p)));
        EXPECT_LE(0, point.x_numerator);
        EXPECT_LT(point.x_numerator, point.denominator);
        // Twice the area of a, b and the point, times its denominator.
        const auto area = [&](ScreenPoint from, ScreenPoint to) {
            const ScreenStep whole = step(from, to);
            const Int128 x = Int128{point.whole.x - from.x} * point.denominator + point.x_numerator;
            const Int128 y = Int128{point.whole.y - from.y} * point.denominator + point.y_numerator;
            return whole.x * y - whole.y * x;
        };
        EXPECT_TRUE(area(a, b) == 0 && area(p, q) == 0);
    }
    EXPECT_GT(crossings, 5'000);
}

/// The same as point_at(), by division of 128 bits.
RationalPoint divided(ScreenPoint a, ScreenPoint b, SegmentPlace place) {
    const ScreenStep whole = step(a, b);
    const Int128 x = Int128{place.numerator} * whole.x + Int128{a.x} * place.denominator;
    const Int128 y = Int128{place.numerator} * whole.y + Int128{a.y} * place.denominator;
    const auto x_rest = static_cast<std::int64_t>(x % place.denominator);
    const auto y_rest = static_cast<std::int64_t>(y % place.denominator);
    const std::int64_t common = std::gcd(std::gcd(x_rest, y_rest), place.denominator);
    return {
        {static_cast<std::int32_t>(x / place.denominator),
         static_cast<std::int32_t>(y / place.denominator)},
        x_rest / common,
        y_rest / common,
        place.denominator / common};
}

TEST(ScreenPoint, PointsAreThoseOfLongDivision) {
    std::mt19937_64 random(3);
    const auto anywhere = [&] {
        const auto x = static_cast<std::int32_t>(random() % (screen_size + 1));
        const auto y = static_cast<std::int32_t>(random() % (screen_size + 1));
        return ScreenPoint{x, y};
    };
    std::size_t reduced = 0;
    for (int i = 0; i < 50'000; ++i) {
        const bool is_few = i % 2 == 0;
        const ScreenPoint a = is_few ? few_point(random) : anywhere();
        const ScreenPoint b = is_few ? few_point(random) : anywhere();
        // Long denominators, short ones, and places next to both ends.
        const auto denominator =
            static_cast<std::int64_t>(1 + (random() >> (18U + random() % 46U)));
        const auto beside = static_cast<std::int64_t>(random() % 3);
        const auto between =
            static_cast<std::int64_t>(random() % (static_cast<std::uint64_t>(denominator) + 1));
        const std::int64_t numerator = i % 3 == 0 ? std::min(beside, denominator)
            : i % 3 == 1                          ? std::max(denominator - beside, std::int64_t{0})
                                                  : between;
        const RationalPoint expected = divided(a, b, {numerator, denominator});
        EXPECT_EQ(point_at(a, b, {numerator, denominator}), expected);
        reduced += expected.denominator < denominator ? 1 : 0;
    }
    EXPECT_GT(reduced, 10'000U);
}

TEST(ScreenPoint, PlacesAreInTheOrderOfTheirPoints) {
    std::mt19937_64 random(2);
    for (int i = 0; i < 100'000; ++i) {
        const ScreenPoint a = few_point(random);
        const ScreenPoint b = few_point(random);
        if (a == b)
            continue;
        // Points of the line that are crossings of the grid.
        const ScreenStep whole = step(a, b);
        const std::int64_t parts = std::array{1, 2, 4}[random() % 3];
        if (whole.x % parts != 0 || whole.y % parts != 0)
            continue;
        const auto part = [&](std::int64_t number) {
            return ScreenPoint{
                static_cast<std::int32_t>(a.x + whole.x / parts * number),
                static_cast<std::int32_t>(a.y + whole.y / parts * number)};
        };
        const auto first = static_cast<std::int64_t>(random() % 5);
        const auto second = static_cast<std::int64_t>(random() % 5);
        EXPECT_EQ(
            order(place_on(a, b, part(first)), place_on(a, b, part(second))), sign(first - second));
        const RationalPoint point = point_at(a, b, place_on(a, b, part(second)));
        EXPECT_EQ(point, (RationalPoint{part(second)}));
    }
}

TEST(ScreenPoint, RationalPointsAreOrderedByXAndThenByY) {
    const RationalPoint third = point_at({0, 0}, {1, 1}, {1, 3});
    const RationalPoint same = point_at({0, 0}, {2, 2}, {1, 6});
    const RationalPoint half = point_at({0, 0}, {1, 1}, {1, 2});
    const RationalPoint lower = point_at({0, 0}, {1, 0}, {1, 3});
    EXPECT_EQ(third, same);
    EXPECT_EQ(order(third, same), 0);
    EXPECT_EQ(order(third, half), -1);
    EXPECT_EQ(order(half, third), 1);
    EXPECT_EQ(order(lower, third), -1);
    EXPECT_EQ(order(RationalPoint{{1, 0}}, third), 1);
    EXPECT_DOUBLE_EQ(third.x(), 1.0 / 3);
}

} // namespace
} // namespace vera
