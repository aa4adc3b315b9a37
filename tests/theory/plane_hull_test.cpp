// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/plane_hull.h"
#include "vera/theory/plane_points.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

namespace vera {
namespace {

using Numbers = std::vector<std::uint32_t>;

Numbers numbers_to(std::size_t count) {
    Numbers numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0U);
    return numbers;
}

TEST(PlaneHull, ReachesAsFarAsThePoints) {
    std::mt19937_64 random(7);
    for (const PointFamily& family : point_families())
        for (int round = 0; round < 300; ++round) {
            const auto points = family.points(1 + random() % 40, random);
            const PlaneHull hull = hull_of(points, numbers_to(points.size()));
            for (int query = 0; query < 10; ++query) {
                const PlaneDirection normal = some_normal(points, random);
                const auto less = [&](PlanePoint a, PlanePoint b) {
                    return dot(normal, a) < dot(normal, b);
                };
                const auto [low, high] = std::minmax_element(points.begin(), points.end(), less);
                const HullExtent extent = extent_along(normal, points, hull.below, hull.above);
                ASSERT_EQ(extent.lowest, dot(normal, *low)) << family.name;
                ASSERT_EQ(extent.highest, dot(normal, *high)) << family.name;
            }
        }
}

TEST(PlaneHull, OfTwoHullsIsThatOfAllTheirPoints) {
    std::mt19937_64 random(8);
    for (const PointFamily& family : point_families())
        for (int round = 0; round < 100; ++round) {
            const auto points = family.points(2 + random() % 40, random);
            const Numbers all = numbers_to(points.size());
            const auto middle = all.begin() + 1 + static_cast<long>(random() % (all.size() - 1));
            const PlaneHull whole = hull_of(points, all);
            const PlaneHull joined = hull_of(
                points,
                hull_of(points, Numbers(all.begin(), middle)),
                hull_of(points, Numbers(middle, all.end())));
            ASSERT_EQ(joined.below, whole.below) << family.name;
            ASSERT_EQ(joined.above, whole.above) << family.name;
        }
}

TEST(PlaneHull, TakesAsManyStepsAsTheLogarithmOfItsVertices) {
    std::mt19937_64 random(9);
    const auto points = circle_points(20000, random);
    const PlaneHull hull = hull_of(points, numbers_to(points.size()));
    ASSERT_GT(hull.below.size() + hull.above.size(), 15000U);
    for (int query = 0; query < 100; ++query) {
        const PlaneDirection normal = some_normal(points, random);
        // Two chains of less than 2^15 vertices, two of them a step, and the one that is found.
        EXPECT_LE(extent_along(normal, points, hull.below, hull.above).vertices, 2U * (2 * 15 + 1));
    }
}

} // namespace
} // namespace vera
