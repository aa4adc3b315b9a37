// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/kd_tree.h"
#include "vera/theory/plane_points.h"

#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(KdTree, CountsWhatLookingAtEachPointCounts) {
    std::mt19937_64 random(1988);
    std::size_t some = 0;
    for (const PointFamily& family : point_families())
        for (int round = 0; round < 60; ++round) {
            const PlanePoints points = family.points(1 + random() % 60, random);
            const KdTree tree(points, 1 + random() % 4);
            for (int query = 0; query < 30; ++query) {
                const PlaneDirection normal = some_normal(points, random);
                const PlaneStrip strip = strip_near(points, normal, random);
                StepCounts counts;
                const std::size_t expected = brute_force_numbers_in(points, strip).size();
                ASSERT_EQ(tree.count(strip, &counts), expected) << family.name;
                ASSERT_GE(counts.nodes, 1U);
                some += expected == 0 || expected == points.size() ? 0 : 1;
            }
        }
    EXPECT_GT(some, 5000U);
    EXPECT_EQ(KdTree(PlanePoints{}).count({{1, 0}}), 0U);
}

} // namespace
} // namespace vera
