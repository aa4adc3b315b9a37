// SPDX-License-Identifier: Apache-2.0
// Generations of rays among rectangles by nested trees, alone and with sweeps at their ends, on all
// threads: beside looking at each, and beside one sweep.
#include "vera/base/available_memory.h"
#include "vera/theory/nested_sweeps.h"
#include "vera/theory/ray_parts.h"
#include "vera/theory/space_sweep.h"
#include "vera/theory/tree_queries.h"

#include <algorithm>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "theory/rectangles.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using Random = std::mt19937_64;
using testing::Rectangles;
using testing::SlopedRays;

FirstRectangles first_by_trees(const Rectangles& rectangles, const SlopedRays& rays) {
    FirstRectangles first(rays.size());
    query_trees(rectangles, {rays}, first_meeting(first));
    return first;
}

FirstRectangles first_by_nested(
    std::size_t level, std::size_t parts, const Rectangles& rectangles, const SlopedRays& rays) {
    FirstRectangles first(rays.size());
    nested_sweeps(level, parts, rectangles, {rays}, first_meeting(first));
    return first;
}

TEST(TreeQueries, FindTheRectanglesThatLookingAtEachFinds) {
    Random random(1988);
    std::size_t met = 0;
    std::size_t missed = 0;
    for (int round = 0; round < 30; ++round)
        for (const testing::RayFamily& family : testing::ray_families()) {
            const Rectangles rectangles = round % 5 == 0
                ? testing::repeated_rectangles(25, random)
                : testing::rectangles_within(random() % 40, 6, round % 3 == 0 ? 2 : 12, random);
            // Now and then enough for several parts.
            const std::size_t count = round % 10 == 3 ? 600 : random() % 100;
            const SlopedRays rays = family.rays(count, 7, 2, random);
            const FirstRectangles expected = brute_force_first_rectangles(rectangles, rays);
            ASSERT_EQ(first_by_trees(rectangles, rays), expected) << family.name;
            for (const auto& [level, parts] : {std::pair{3, 1}, {5, 3}, {2, 7}})
                ASSERT_EQ(
                    first_by_nested(
                        static_cast<std::size_t>(level),
                        static_cast<std::size_t>(parts),
                        rectangles,
                        rays),
                    expected)
                    << family.name << ", level " << level << ", parts " << parts;
            for (const auto& first : expected)
                ++(first ? met : missed);
        }
    EXPECT_GT(met, 2000U);
    EXPECT_GT(missed, 2000U);
}

/// What each ray met, and in which order.
using Met = std::vector<std::vector<std::uint32_t>>;

/// Rays that go on for a while behind what they meet, as behind what their box alone has met.
Meeting meeting_of_some(Met& met, const Rectangles& rectangles) {
    return [&](std::uint32_t rectangle, std::uint32_t ray) {
        met[ray].push_back(rectangle);
        return rectangles[met[ray].front()].z + 5;
    };
}

TEST(TreeQueries, EndRaysWhereOneSweepDoes) {
    Random random(3);
    for (const std::size_t count : {300U, 900U}) {
        const Rectangles rectangles = testing::rectangles_within(200, 50, 40, random);
        const SlopedRays rays = testing::sloped_rays_within(count, 50, 2, random);
        std::vector<std::int32_t> last_z(rays.size());
        for (std::int32_t& z : last_z)
            z = testing::any_within(60, random);
        Met expected(rays.size());
        sweep(rectangles, {rays, last_z}, meeting_of_some(expected, rectangles));
        Met by_trees(rays.size());
        query_trees(rectangles, {rays, last_z}, meeting_of_some(by_trees, rectangles));
        EXPECT_EQ(by_trees, expected);
        for (const std::size_t parts : {0U, 2U}) {
            Met by_nested(rays.size());
            nested_sweeps(
                4, parts, rectangles, {rays, last_z}, meeting_of_some(by_nested, rectangles));
            EXPECT_EQ(by_nested, expected) << parts;
        }
    }
}

TEST(TreeQueries, AreTheSameForAnyNumberOfThreads) {
    Random random(4);
    const Rectangles rectangles = testing::rectangles_within(300, 500, 100, random);
    const SlopedRays rays = testing::sloped_rays_within(2100, 500, 3, random);
    ASSERT_EQ(usual_parts_level(rays.size()), 3U);
    const FirstRectangles expected = brute_force_first_rectangles(rectangles, rays);
    std::vector<std::uint64_t> steps;
    for (const std::size_t threads : {1U, 2U, 3U, 8U}) {
        const ThreadLimit limit(threads);
        FirstRectangles first(rays.size());
        StepCounts trees;
        query_trees(rectangles, {rays}, first_meeting(first), &trees);
        EXPECT_EQ(first, expected) << threads;
        FirstRectangles by_nested(rays.size());
        NestedSweepCounts nested;
        nested_sweeps(6, 3, rectangles, {rays}, first_meeting(by_nested), &nested);
        EXPECT_EQ(by_nested, expected) << threads;
        const std::vector<std::uint64_t> counted = {
            trees.steps(), nested.trees.steps(), nested.sweeps.steps()};
        if (steps.empty())
            steps = counted;
        EXPECT_EQ(counted, steps) << threads;
        EXPECT_GT(*std::min_element(counted.begin(), counted.end()), rays.size());
    }
}

TEST(TreeQueries, AreRefusedBeforeMemoryRunsOut) {
    const Rectangles rectangles(3);
    const SlopedRays rays(200'000);
    const MemoryLimit little(1);
    try {
        first_by_trees(rectangles, rays);
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(
            error.what(),
            ::testing::StartsWith("nesting trees of 200000 rays among 3 rectangles takes about "));
    }
    EXPECT_THROW(first_by_nested(4, 2, rectangles, rays), std::runtime_error);
}

TEST(TreeQueries, TellHowFarTheyAreAndCanBeStopped) {
    Random random(10);
    const Rectangles rectangles = testing::rectangles_within(50, 1000, 50, random);
    const SlopedRays rays = testing::sloped_rays_within(2100, 1000, 3, random);
    FirstRectangles first(rays.size());
    for (const bool nested : {false, true}) {
        double last = 0;
        int calls = 0;
        const Progress note = [&](double done) {
            EXPECT_GE(done, last);
            last = done;
            ++calls;
        };
        CancelFlag cancel;
        const auto ask = [&](const Progress& progress) {
            if (nested)
                nested_sweeps(
                    5, 3, rectangles, {rays}, first_meeting(first), nullptr, progress, &cancel);
            else
                query_trees(rectangles, {rays}, first_meeting(first), nullptr, progress, &cancel);
        };
        ask(note);
        EXPECT_EQ(last, 1);
        EXPECT_GT(calls, 3);
        cancel.raise();
        EXPECT_THROW(ask({}), Cancelled);
    }
}

} // namespace
} // namespace vera
