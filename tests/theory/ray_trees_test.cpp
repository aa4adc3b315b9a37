// SPDX-License-Identifier: Apache-2.0
#include "vera/base/available_memory.h"
#include "vera/theory/growth.h"
#include "vera/theory/ray_trees.h"
#include "vera/theory/tree_queries.h"

#include <algorithm>
#include <cmath>
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
using testing::Rectangles;
using testing::rectangles_within;
using testing::SlopedRays;

/// Of few values: rays through corners and along borders, and planes that coincide.
Rectangles few_valued_rectangles(std::size_t count, Random& random) {
    return random() % 3 == 0 ? testing::repeated_rectangles(count, random)
                             : rectangles_within(count, 5, 6, random);
}

TEST(RayTrees, FindTheRectanglesThatLookingAtEachPairFinds) {
    Random random(1988);
    std::size_t met = 0;
    std::size_t missed = 0;
    for (int round = 0; round < 300; ++round)
        for (const testing::RayFamily& family : testing::ray_families()) {
            const Rectangles rectangles = few_valued_rectangles(random() % 40, random);
            const SlopedRays rays = family.rays(random() % 60, 5, 2, random);
            const RayTrees trees(rays, 1 + random() % 4);
            const FirstRectangles expected = brute_force_first_rectangles(rectangles, rays);
            ASSERT_EQ(first_rectangles(rectangles, trees), expected) << family.name;
            const auto hits = static_cast<std::size_t>(std::count_if(
                expected.begin(), expected.end(), [](const auto& hit) { return hit.has_value(); }));
            met += hits;
            missed += rays.size() - hits;
        }
    EXPECT_GT(met, 5000U);
    EXPECT_GT(missed, 5000U);
}

TEST(RayTrees, TellTheRaysThatLookingAtEachTells) {
    Random random(2);
    std::size_t some = 0;
    for (int round = 0; round < 100; ++round)
        for (const testing::RayFamily& family : testing::ray_families()) {
            const SlopedRays rays = family.rays(1 + random() % 80, 5, 2, random);
            const RayTrees trees(rays, 1 + random() % 4);
            for (const IsoRectangle& rectangle : few_valued_rectangles(40, random)) {
                const auto expected = brute_force_rays_met(rectangle, rays);
                ASSERT_EQ(trees.rays_met(rectangle), expected) << family.name;
                some += expected.empty() || expected.size() == rays.size() ? 0 : 1;
            }
        }
    EXPECT_GT(some, 2000U);
}

TEST(RayTrees, AnswerAtTheLargestNumbers) {
    Random random(3);
    constexpr std::int32_t reach = largest_plane_coordinate;
    std::size_t met = 0;
    for (int round = 0; round < 20; ++round) {
        const Rectangles rectangles = rectangles_within(60, reach, reach, random);
        const SlopedRays rays = testing::sloped_rays_within(60, reach, round % 2, random);
        const FirstRectangles expected = brute_force_first_rectangles(rectangles, rays);
        ASSERT_EQ(first_rectangles(rectangles, RayTrees(rays, 2)), expected);
        met += static_cast<std::size_t>(std::count_if(
            expected.begin(), expected.end(), [](const auto& hit) { return hit.has_value(); }));
    }
    EXPECT_GT(met, 100U);
}

TEST(LiveRays, AreCountedInEachNode) {
    Random random(4);
    for (const testing::RayFamily& family : testing::ray_families()) {
        const SlopedRays rays = family.rays(200, 20, 3, random);
        const RayTrees trees(rays, 4);
        LiveRays live(trees);
        StepCounts counts;
        std::vector<bool> expected(rays.size());
        for (int turn = 0; turn < 500; ++turn) {
            const auto ray = static_cast<std::uint32_t>(random() % rays.size());
            expected[ray] ? live.remove(ray, counts) : live.add(ray, counts);
            expected[ray] = !expected[ray];
        }
        std::size_t nodes = 0;
        for (std::uint32_t ray = 0; ray < rays.size(); ++ray)
            trees.for_each_node_of(ray, [&](RayTreeNode node) {
                const auto held = node.rays();
                ASSERT_EQ(std::count(held.begin(), held.end(), ray), 1);
                ASSERT_EQ(
                    live.count_in(node),
                    std::count_if(held.begin(), held.end(), [&](std::uint32_t number) {
                        return expected[number];
                    }));
                ++nodes;
            });
        EXPECT_GT(nodes, 10 * rays.size());
        EXPECT_EQ(
            live.count(),
            static_cast<std::size_t>(std::count(expected.begin(), expected.end(), true)));
    }
}

/// Notes what a visitor is told of each ray.
struct NotedRays {
    std::vector<int>& times;
    std::vector<std::string>& told;

    bool enters(RayTreeNode /*node*/) const { return true; }

    void met(RayTreeNode node) const { note(node, "met"); }

    void open_in_y(RayTreeNode node) const { note(node, "open in y"); }

    void open(RayTreeNode node) const { note(node, "open"); }

    void note(RayTreeNode node, const char* what) const {
        for (const std::uint32_t ray : node.rays()) {
            ++times[ray];
            told[ray] = what;
        }
    }
};

TEST(RayTrees, LeaveToAVisitorWhatHappensAtTheirEnds) {
    Random random(5);
    std::vector<std::string> seen;
    for (const std::size_t few : {1U, 8U, 50U, 1000U}) {
        const SlopedRays rays = testing::sloped_rays_within(400, 1000, 2, random);
        const RayTrees trees(rays, few);
        for (const IsoRectangle& rectangle : rectangles_within(50, 1000, 2000, random)) {
            std::vector<int> times(rays.size());
            std::vector<std::string> told(rays.size());
            StepCounts counts;
            trees.visit(rectangle, counts, NotedRays{times, told});
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const bool in_x = contains(x_strip(rectangle), x_point(rays[i]));
                const bool in_y = contains(y_strip(rectangle), y_point(rays[i]));
                ASSERT_LE(times[i], 1) << "nodes have rays in common";
                ASSERT_TRUE(times[i] == 1 || !in_x || !in_y) << "a ray is forgotten";
                ASSERT_TRUE(told[i] != "met" || (in_x && in_y));
                ASSERT_TRUE(told[i] != "open in y" || in_x);
                seen.push_back(told[i]);
            }
        }
    }
    for (const char* what : {"", "met", "open in y", "open"})
        EXPECT_GT(std::count(seen.begin(), seen.end(), what), 100) << what;
}

/// Looks at all that a query has to look at, and tells nothing.
struct CountedSteps {
    StepCounts& counts;

    bool enters(RayTreeNode /*node*/) const { return true; }

    void met(RayTreeNode /*node*/) const {}

    void open_in_y(RayTreeNode node) const { counts.points += node.rays().size(); }

    void open(RayTreeNode node) const { counts.points += node.rays().size(); }
};

/// How the steps of so many rectangles, but for telling the rays, grow with the number of these.
Growth growth_of_steps(const testing::RayFamily& family, std::int32_t size, Random& random) {
    constexpr std::int32_t reach = 200'000;
    std::vector<double> sizes;
    std::vector<double> steps;
    for (std::size_t count = 256; count <= 8192; count *= 2) {
        const RayTrees trees(family.rays(count, reach, 1000, random), 8);
        StepCounts counts;
        for (const IsoRectangle& rectangle : rectangles_within(300, 1000, size, random))
            trees.visit(rectangle, counts, CountedSteps{counts});
        sizes.push_back(static_cast<double>(count));
        steps.push_back(static_cast<double>(counts.nodes + counts.points));
    }
    return growth(sizes, steps);
}

TEST(RayTrees, TakeStepsThatGrowNoFasterThanThePaperSays) {
    constexpr double bound = 0.695; // to which a polylogarithm may add, and does not
    Random random(6);
    for (const std::int32_t size : {0, 1'000'000})
        for (const testing::RayFamily& family : testing::ray_families()) {
            const Growth found = growth_of_steps(family, size, random);
            EXPECT_LT(found.exponent - found.uncertainty, bound) << family.name;
            RecordProperty(
                family.name + std::to_string(size),
                std::to_string(found.exponent) + " +- " + std::to_string(found.uncertainty));
        }
}

TEST(RayTrees, TellRaysThatAreEqualWithoutLookingAtThoseThatAreNotLive) {
    // All on one point of both planes, each beginning behind another rectangle, which it meets.
    constexpr std::int32_t count = 2000;
    SlopedRays rays(count);
    Rectangles rectangles(count);
    for (std::int32_t i = 0; i < count; ++i) {
        rays[static_cast<std::size_t>(i)].first_z = i;
        rectangles[static_cast<std::size_t>(i)] = {i, -1, 1, -1, 1};
    }
    StepCounts counts;
    const FirstRectangles first = first_rectangles(rectangles, RayTrees(rays), &counts);
    for (std::size_t i = 0; i < first.size(); ++i)
        ASSERT_EQ(first[i], i);
    EXPECT_LT(counts.points, 100U * count);
    EXPECT_LT(counts.counters, 500U * count);
}

TEST(RayTrees, TakeNoMoreMemoryThanForecast) {
    Random random(7);
    for (const testing::RayFamily& family : testing::ray_families())
        for (const std::size_t count : {0U, 1U, 5U, 100U, 3000U})
            for (const std::size_t few : {1U, 8U, 32U}) {
                const RayTrees trees(family.rays(count, 100'000, 1000, random), few);
                const double forecast = RayTrees::bytes_forecast(count, few);
                const auto bytes =
                    static_cast<double>(trees.bytes() + trees.node_count() * sizeof(std::uint32_t));
                EXPECT_LE(bytes, forecast) << family.name << ' ' << count << ' ' << few;
                if (count >= 100) {
                    EXPECT_GE(bytes, 0.25 * forecast) << family.name << ' ' << count << ' ' << few;
                }
            }
}

TEST(RayTrees, AreRefusedBeforeMemoryRunsOut) {
    const SlopedRays rays(1'000'000);
    const MemoryLimit little(1);
    try {
        const RayTrees trees(rays);
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(
            error.what(),
            ::testing::AllOf(
                ::testing::StartsWith("nesting trees of 1000000 rays down to 32 takes about "),
                ::testing::EndsWith(": trees that end at more rays, as at 256, and trees of fewer "
                                    "rays take less")));
    }
}

TEST(RayTrees, RefuseWhatTheyCannotHold) {
    const auto refusal = [](const auto& ask) -> std::string {
        try {
            ask();
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(
        refusal([] {
            const RayTrees trees(SlopedRays{{}, {0, 1073741825, 0, 0, 0}});
        }),
        "ray 1 has the number 1073741825, and the largest magnitude is 1073741824: scale "
        "everything down");
    const RayTrees trees(SlopedRays(3));
    EXPECT_EQ(
        refusal([&] {
            first_rectangles(Rectangles{{}, {0, 2, 1, 0, 0}}, trees);
        }),
        "rectangle 1 has a lower side above its upper side: exchange the two");
    EXPECT_EQ(
        refusal([&] {
            trees.rays_met({0, 2, 1, 0, 0});
        }),
        "rectangle 0 has a lower side above its upper side: exchange the two");
}

TEST(RayTrees, TellHowFarTheyAreAndCanBeStopped) {
    Random random(8);
    const SlopedRays rays = testing::sloped_rays_within(500, 1000, 20, random);
    double last = 0;
    const auto note = [&](double done) {
        EXPECT_GE(done, last);
        last = done;
    };
    const RayTrees trees(rays, 8, note);
    EXPECT_EQ(last, 1);
    last = 0;
    const Rectangles rectangles = rectangles_within(100, 1000, 50, random);
    first_rectangles(rectangles, trees, nullptr, note);
    EXPECT_EQ(last, 1);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(RayTrees(rays, 8, {}, &cancel), Cancelled);
    EXPECT_THROW(first_rectangles(rectangles, trees, nullptr, {}, &cancel), Cancelled);
}

} // namespace
} // namespace vera
