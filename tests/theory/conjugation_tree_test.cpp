// SPDX-License-Identifier: Apache-2.0
#include "vera/base/available_memory.h"
#include "vera/theory/conjugation_tree.h"
#include "vera/theory/plane_points.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

/// The bound of the header, on how many nodes a query with one border looks at.
std::uint64_t most_nodes(std::size_t height) {
    std::uint64_t before = 1;
    std::uint64_t most = height == 0 ? 1 : 3;
    for (std::size_t h = 2; h <= height; ++h)
        before = std::exchange(most, most + before + 3);
    return most;
}

/// What a query may see of the nodes below one.
class CrossedNodes {
public:
    CrossedNodes(const ConjugationTree& tree, const PlaneStrip& strip)
        : tree_(tree)
        , strip_(strip) {}

    bool crosses(std::uint32_t node) {
        return tree_.inclusion(tree_.nodes()[node], strip_, counts_) == Inclusion::some;
    }

    int crossed_children(std::uint32_t node) {
        const ConjugationNode& parent = tree_.nodes()[node];
        return parent.is_leaf() ? 0 : int{crosses(node + 1)} + int{crosses(parent.children)};
    }

    /// The most grandchildren that any node has whose points lie on both sides of the border.
    int most_grandchildren() {
        int most = 0;
        for (std::uint32_t node = 0; node < tree_.nodes().size(); ++node)
            if (!tree_.nodes()[node].is_leaf())
                most = std::max(
                    most,
                    crossed_children(node + 1) + crossed_children(tree_.nodes()[node].children));
        return most;
    }

private:
    const ConjugationTree& tree_;
    PlaneStrip strip_;
    StepCounts counts_;
};

std::size_t height(const ConjugationTree& tree, std::uint32_t node = 0) {
    const ConjugationNode& parent = tree.nodes()[node];
    return parent.is_leaf() ? 0
                            : 1 + std::max(height(tree, node + 1), height(tree, parent.children));
}

TEST(ConjugationTree, FindsWhatLookingAtEachPointFinds) {
    std::mt19937_64 random(1988);
    std::size_t some = 0;
    for (const PointFamily& family : point_families())
        for (int round = 0; round < 300; ++round) {
            const PlanePoints points = family.points(1 + random() % 60, random);
            const ConjugationTree tree(points, 1 + random() % 4);
            for (int query = 0; query < 40; ++query) {
                const PlaneStrip strip = strip_near(points, some_normal(points, random), random);
                const auto expected = brute_force_numbers_in(points, strip);
                ASSERT_EQ(tree.numbers_in(strip), expected) << family.name;
                ASSERT_EQ(tree.count(strip), expected.size()) << family.name;
                some += expected.empty() || expected.size() == points.size() ? 0 : 1;
            }
        }
    EXPECT_GT(some, 50000U);
}

TEST(ConjugationTree, OfFourQuartersABorderCrossesThree) {
    std::mt19937_64 random(3);
    for (const PointFamily& family : point_families())
        for (int round = 0; round < 40; ++round) {
            const PlanePoints points = family.points(60, random);
            const ConjugationTree tree(points, 1);
            for (int query = 0; query < 40; ++query) {
                const PlaneStrip half =
                    half_plane_near(points, some_normal(points, random), random);
                ASSERT_LE(CrossedNodes(tree, half).most_grandchildren(), 3) << family.name;
            }
        }
}

TEST(ConjugationTree, LooksAtNoMoreNodesThanTheBoundSays) {
    std::mt19937_64 random(4);
    for (const PointFamily& family : point_families())
        for (const std::size_t count : {50U, 400U, 3000U}) {
            const PlanePoints points = family.points(count, random);
            const ConjugationTree tree(points, 1);
            const std::uint64_t bound = most_nodes(height(tree));
            for (int query = 0; query < 200; ++query) {
                StepCounts counts;
                const PlaneStrip strip = strip_near(points, some_normal(points, random), random);
                tree.count(strip, &counts);
                const bool is_half_plane =
                    strip.lowest == PlaneStrip().lowest || strip.highest == PlaneStrip().highest;
                ASSERT_LE(counts.nodes, is_half_plane ? bound : 2 * bound) << family.name;
                ASSERT_LE(counts.points, counts.nodes);
            }
        }
}

TEST(ConjugationTree, TakesNoMoreMemoryThanForecast) {
    std::mt19937_64 random(6);
    for (const PointFamily& family : point_families())
        for (const std::size_t count : {1U, 2U, 77U, 1000U, 5000U})
            for (const std::size_t leaf_size : {1U, 8U, 100U}) {
                const PlanePoints points = family.points(count, random);
                const auto bytes = static_cast<double>(ConjugationTree(points, leaf_size).bytes());
                ASSERT_LE(bytes, ConjugationTree::bytes_forecast(count, leaf_size))
                    << family.name << ' ' << count << ' ' << leaf_size;
            }
    // Where each point is a vertex, that is about what it takes.
    const PlanePoints circle = circle_points(5000, random);
    EXPECT_GT(
        static_cast<double>(ConjugationTree(circle).bytes()),
        0.7 * ConjugationTree::bytes_forecast(5000));
}

TEST(ConjugationTree, IsRefusedBeforeMemoryRunsOut) {
    const PlanePoints points(1'000'000);
    const MemoryLimit little(1);
    try {
        const ConjugationTree tree(points);
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(
            error.what(),
            ::testing::AllOf(
                ::testing::StartsWith("a conjugation tree of 1000000 points takes about "),
                ::testing::EndsWith(
                    ": fewer points, and leaves of more than 8 points, take less")));
    }
}

TEST(ConjugationTree, OfEqualPointsIsOneNode) {
    const PlanePoints points(1000, PlanePoint{7, -3});
    const ConjugationTree tree(points);
    EXPECT_EQ(tree.nodes().size(), 1U);
    EXPECT_EQ(tree.count({{1, 0}, 7, 7}), 1000U);
    EXPECT_EQ(tree.count({{1, 0}, 8}), 0U);
}

TEST(ConjugationTree, OfNoPointsFindsNothing) {
    EXPECT_EQ(ConjugationTree().count({{1, 0}}), 0U);
    EXPECT_TRUE(ConjugationTree(PlanePoints{}).numbers_in({{1, 0}}).empty());
}

TEST(ConjugationTree, RefusesWhatItsNumbersCannotHold) {
    const PlanePoints large = {{0, 0}, {0, largest_plane_coordinate + 1}};
    try {
        const ConjugationTree tree(large);
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(
            error.what(),
            "point 1 has the coordinate 1073741825, and the largest magnitude is 1073741824: scale "
            "the points down");
    }
    const PlanePoints points = {{0, 0}};
    try {
        ConjugationTree(points).count({{0, -largest_plane_direction - 1}});
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(
            error.what(),
            "the strip's normal has the component -2147483649, and the largest magnitude is "
            "2147483648: divide the normal and both bounds by their common factors");
    }
}

TEST(ConjugationTree, TellsHowFarItIsAndCanBeStopped) {
    std::mt19937_64 random(7);
    const PlanePoints points = scattered_points(2000, random);
    double last = 0;
    const ConjugationTree tree(points, 8, [&](double done) {
        EXPECT_GE(done, last);
        last = done;
    });
    EXPECT_EQ(last, 1);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(ConjugationTree(points, 8, {}, &cancel), Cancelled);
}

} // namespace
} // namespace vera
