// SPDX-License-Identifier: Apache-2.0
#include "vera/base/available_memory.h"
#include "vera/theory/growth.h"
#include "vera/theory/nested_trees.h"
#include "vera/theory/optimal_partition_tree.h"
#include "vera/theory/plane_points.h"
#include "vera/theory/tree_queries.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "theory/rectangles.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using Random = std::mt19937_64;

TEST(OptimalPartitionTree, FindsWhatLookingAtEachPointFinds) {
    Random random(1988);
    std::size_t some = 0;
    for (const PointFamily& family : point_families())
        for (int round = 0; round < 100; ++round) {
            const PlanePoints points = family.points(1 + random() % 120, random);
            const OptimalPartitionTree tree(points, 1 + random() % 4);
            for (int query = 0; query < 40; ++query) {
                const PlaneStrip strip = strip_near(points, some_normal(points, random), random);
                const auto expected = brute_force_numbers_in(points, strip);
                ASSERT_EQ(tree.numbers_in(strip), expected) << family.name;
                ASSERT_EQ(tree.count(strip), expected.size()) << family.name;
                some += expected.empty() || expected.size() == points.size() ? 0 : 1;
            }
        }
    EXPECT_GT(some, 10000U);
}

TEST(OptimalPartitionTree, DividesEveryNodeOfMoreThanALeafUnlessItsPointsAreEqual) {
    Random random(2);
    for (const EqualPoints equal : {EqualPoints::together, EqualPoints::apart})
        for (const PointFamily& family : point_families()) {
            const PlanePoints points = family.points(500, random);
            std::vector<std::uint32_t> numbers(points.size());
            std::iota(numbers.begin(), numbers.end(), std::uint32_t{0});
            const OptimalPartitionTree tree(points, numbers, 5, {}, nullptr, equal);
            std::vector<std::uint32_t> held(tree.numbers().begin(), tree.numbers().end());
            std::sort(held.begin(), held.end());
            ASSERT_EQ(held, numbers) << family.name;
            for (const PartitionNode& node : tree.nodes()) {
                const auto here = tree.numbers_of(node);
                ASSERT_FALSE(here.empty());
                const bool are_equal =
                    std::all_of(here.begin(), here.end(), [&](std::uint32_t number) {
                        return points[number] == points[here[0]];
                    });
                const bool is_small =
                    here.size() <= 5 || (are_equal && equal == EqualPoints::together);
                ASSERT_EQ(node.is_leaf(), is_small) << family.name;
            }
        }
}

/// The most nodes that a query with one border of many looks at.
double nodes_of_queries(const PlanePoints& points, Random& random) {
    const OptimalPartitionTree tree(points, 1);
    std::uint64_t most = 0;
    for (int query = 0; query < 300; ++query) {
        PlaneStrip strip = strip_near(points, some_normal(points, random), random);
        if (strip.highest != PlaneStrip().highest)
            strip.lowest = PlaneStrip().lowest;
        StepCounts counts;
        tree.count(strip, &counts);
        most = std::max(most, counts.nodes);
    }
    return static_cast<double>(most);
}

TEST(OptimalPartitionTree, LooksAtNodesThatGrowNoFasterThanTheSquareRoot) {
    Random random(3);
    for (const PointFamily& family : point_families()) {
        std::vector<double> sizes;
        std::vector<double> counts;
        for (std::size_t count = 128; count <= 8192; count *= 2) {
            sizes.push_back(static_cast<double>(count));
            counts.push_back(nodes_of_queries(family.points(count, random), random));
        }
        const Growth found = growth(sizes, counts);
        EXPECT_LT(found.exponent - found.uncertainty, 0.5) << family.name;
        EXPECT_LT(found.uncertainty, 0.15) << family.name << " tells nothing";
        EXPECT_LT(counts.back(), 12 * std::sqrt(sizes.back())) << family.name;
        RecordProperty(std::string(family.name), std::to_string(found.exponent));
    }
}

TEST(OptimalPartitionTree, TakesNoMoreMemoryThanForecast) {
    Random random(4);
    for (const PointFamily& family : point_families())
        for (const std::size_t count : {1U, 2U, 77U, 1000U, 5000U})
            for (const std::size_t leaf_size : {1U, 8U, 100U}) {
                const PlanePoints points = family.points(count, random);
                const auto bytes =
                    static_cast<double>(OptimalPartitionTree(points, leaf_size).bytes());
                ASSERT_LE(bytes, OptimalPartitionTree::bytes_forecast(count, leaf_size))
                    << family.name << ' ' << count << ' ' << leaf_size;
            }
}

TEST(OptimalPartitionTree, IsRefusedBeforeMemoryRunsOut) {
    const PlanePoints points(1'000'000);
    const MemoryLimit little(1);
    try {
        const OptimalPartitionTree tree(points);
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(
            error.what(),
            ::testing::AllOf(
                ::testing::StartsWith("an optimal partition tree of 1000000 points takes about "),
                ::testing::EndsWith(
                    ": fewer points, and leaves of more than 8 points, take less")));
    }
}

TEST(OptimalPartitionTree, OfNoPointsFindsNothingAndOfLargeOnesIsRefused) {
    EXPECT_EQ(OptimalPartitionTree(PlanePoints{}).count({{1, 0}}), 0U);
    const PlanePoints large = {{0, 0}, {0, largest_plane_coordinate + 1}};
    EXPECT_THROW(const OptimalPartitionTree tree(large), std::invalid_argument);
}

TEST(OptimalPartitionTree, TellsHowFarItIsAndCanBeStopped) {
    Random random(5);
    const PlanePoints points = scattered_points(2000, random);
    double last = 0;
    const OptimalPartitionTree tree(points, 8, [&](double done) {
        EXPECT_GE(done, last);
        last = done;
    });
    EXPECT_EQ(last, 1);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(OptimalPartitionTree(points, 8, {}, &cancel), Cancelled);
}

TEST(NestedTrees, OfOptimalTreesAnswerTheSame) {
    Random random(6);
    for (int round = 0; round < 40; ++round) {
        const auto rectangles = testing::rectangles_within(1 + random() % 150, 6, 5, random);
        const NestedTrees trees(rectangles, 1 + random() % 3, {}, nullptr, TreeKind::optimal);
        for (int i = 0; i < 100; ++i) {
            const WholeRay ray = testing::ray_within(7, 2, random);
            ASSERT_EQ(trees.first_rectangle(ray), brute_force_first_rectangle(rectangles, ray));
        }
    }
    const auto rectangles = testing::rectangles_within(1000, 1000, 50, random);
    EXPECT_LE(
        static_cast<double>(NestedTrees(rectangles, 8, {}, nullptr, TreeKind::optimal).bytes()),
        NestedTrees::bytes_forecast(1000, 8, TreeKind::optimal));
}

TEST(RayTrees, OfOptimalTreesAnswerTheSame) {
    Random random(7);
    for (int round = 0; round < 50; ++round)
        for (const testing::RayFamily& family : testing::ray_families()) {
            const auto rectangles = testing::rectangles_within(40, 5, 6, random);
            const auto rays = family.rays(1 + random() % 150, 5, 2, random);
            const RayTrees trees(rays, 1 + random() % 4, {}, nullptr, TreeKind::optimal);
            ASSERT_EQ(
                first_rectangles(rectangles, trees), brute_force_first_rectangles(rectangles, rays))
                << family.name;
            EXPECT_LE(
                static_cast<double>(trees.bytes()),
                RayTrees::bytes_forecast(rays.size(), 1, TreeKind::optimal));
        }
}

} // namespace
} // namespace vera
