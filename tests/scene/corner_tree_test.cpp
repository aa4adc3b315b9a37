// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/corner_tree.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vera::detail {
namespace {

std::vector<std::uint32_t> all_of(const std::vector<FlatPoint>& points) {
    std::vector<std::uint32_t> corners(points.size());
    std::iota(corners.begin(), corners.end(), 0U);
    return corners;
}

bool is_in(const std::array<FlatPoint, 3>& t, FlatPoint point) {
    return point.x >= std::min({t[0].x, t[1].x, t[2].x})
        && point.x <= std::max({t[0].x, t[1].x, t[2].x}) && turn(t[0], t[1], point) >= 0
        && turn(t[1], t[2], point) >= 0 && turn(t[2], t[0], point) >= 0;
}

TEST(CornerTree, FindsWhatLookingAtEachCornerFinds) {
    std::mt19937 random(1988);
    // Thirds are rounded, so that what lies on a side for us does not for turn().
    const auto coordinate = [&] { return static_cast<double>(random() % 7) / 3; };
    const auto point = [&] {
        const double x = coordinate();
        return FlatPoint{x, coordinate()};
    };
    int found = 0;
    for (int round = 0; round < 2000; ++round) {
        std::vector<FlatPoint> points(random() % 60);
        std::generate(points.begin(), points.end(), point);
        CornerTree tree(points);
        tree.build(all_of(points));
        ASSERT_EQ(tree.size(), points.size());
        for (int i = 0; i < 10; ++i) {
            std::array<FlatPoint, 3> triangle;
            std::generate(triangle.begin(), triangle.end(), point);
            const auto left_out = static_cast<std::uint32_t>(random() % 3);
            const auto is_meant = [&](std::uint32_t corner) { return corner % 3 != left_out; };
            bool expected = false;
            for (std::uint32_t corner = 0; corner < points.size(); ++corner)
                expected = expected || (is_meant(corner) && is_in(triangle, points[corner]));
            std::size_t steps = std::numeric_limits<std::size_t>::max();
            ASSERT_EQ(tree.is_any_in(triangle, is_meant, steps), expected) << "round " << round;
            found += expected ? 1 : 0;
        }
    }
    EXPECT_GT(found, 2000);
    EXPECT_LT(found, 18'000);
}

TEST(CornerTree, FindsOneOfThemOrNoneWhenStepsRunOut) {
    const std::vector<FlatPoint> points(100, {5, 5});
    CornerTree tree(points);
    tree.build(all_of(points));
    const auto any = [](std::uint32_t) { return true; };
    std::size_t steps = 2;
    EXPECT_FALSE(tree.is_any_in({{{0, 0}, {1, 0}, {0, 1}}}, any, steps));
    EXPECT_EQ(steps, 1U);
    EXPECT_TRUE(tree.is_any_in({{{0, 0}, {20, 0}, {0, 20}}}, any, steps));
    EXPECT_EQ(steps, 0U);
    EXPECT_TRUE(tree.is_any_in({{{0, 0}, {1, 0}, {0, 1}}}, any, steps));
}

/// The triangles of a fan are as wide as all corners together, which lie on a line, and hold two.
TEST(CornerTree, LooksAtFewCornersBesideAWideTriangle) {
    for (const std::uint32_t count : {1000U, 30'000U}) {
        std::vector<FlatPoint> points;
        for (std::uint32_t i = 0; i < count; ++i)
            points.push_back({static_cast<double>(i), 0});
        CornerTree tree(points);
        tree.build(all_of(points));
        std::size_t steps = std::numeric_limits<std::size_t>::max();
        const std::size_t before = steps;
        for (std::uint32_t i = 0; i + 1 < count; ++i) {
            const auto is_other = [&](std::uint32_t j) { return j != i && j != i + 1; };
            const std::array<FlatPoint, 3> fan = {
                {{static_cast<double>(count), -1}, points[i + 1], points[i]}};
            ASSERT_FALSE(tree.is_any_in(fan, is_other, steps));
        }
        EXPECT_LT(before - steps, 60 * std::size_t{count});
    }
}

} // namespace
} // namespace vera::detail
