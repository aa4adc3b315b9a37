// SPDX-License-Identifier: Apache-2.0
#include "vera/base/available_memory.h"
#include "vera/theory/grouped_sweeps.h"
#include "vera/theory/growth.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "theory/rectangles.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using Random = std::mt19937_64;
using testing::Crowd;
using testing::Rectangles;
using testing::SlopedRays;

TEST(GroupedSweeps, FindTheRectanglesThatLookingAtEachFindsAtEveryLevel) {
    Random random(1988);
    std::size_t asked = 0;
    for (int round = 0; round < 40; ++round)
        for (const testing::RayFamily& family : testing::ray_families()) {
            const Rectangles rectangles = round % 5 == 0
                ? testing::repeated_rectangles(25, random)
                : testing::rectangles_within(random() % 40, 6, round % 3 == 0 ? 2 : 12, random);
            const std::size_t count = random() % 100;
            const SlopedRays rays = family.rays(count, 7, 2, random);
            const FirstRectangles expected = brute_force_first_rectangles(rectangles, rays);
            for (std::size_t level = 0; level <= 7; ++level) {
                ASSERT_EQ(sweep_groups_first_rectangles(level, rectangles, rays), expected)
                    << family.name << ", level " << level;
                asked += rays.size();
            }
        }
    EXPECT_GT(asked, 50000U);
}

TEST(GroupedSweeps, EndRaysWhereOneSweepDoes) {
    Random random(3);
    const Rectangles rectangles = testing::rectangles_within(200, 50, 40, random);
    const SlopedRays rays = testing::sloped_rays_within(300, 50, 2, random);
    std::vector<std::int32_t> last_z(rays.size());
    for (std::int32_t& z : last_z)
        z = testing::any_within(60, random);
    using Met = std::vector<std::vector<std::uint32_t>>;
    const auto meeting = [&](Met& met) -> Meeting {
        return [&](std::uint32_t rectangle, std::uint32_t ray) {
            met[ray].push_back(rectangle);
            return rectangles[met[ray].front()].z + 5;
        };
    };
    Met expected(rays.size());
    sweep(rectangles, {rays, last_z}, meeting(expected));
    for (const std::size_t level : {1U, 4U, 8U}) {
        Met met(rays.size());
        sweep_groups(level, rectangles, {rays, last_z}, meeting(met));
        EXPECT_EQ(met, expected);
    }
}

TEST(GroupedSweeps, AreTheSameForAnyNumberOfThreads) {
    Random random(4);
    const Rectangles rectangles = testing::rectangles_within(300, 500, 100, random);
    const SlopedRays rays = testing::sloped_rays_within(400, 500, 3, random);
    FirstRectangles expected;
    SweepCounts expected_counts;
    for (const std::size_t threads : {1U, 2U, 7U}) {
        const ThreadLimit limit(threads);
        SweepCounts counts;
        const auto found = sweep_groups_first_rectangles(5, rectangles, rays, &counts);
        if (threads == 1) {
            expected = found;
            expected_counts = counts;
        }
        EXPECT_EQ(found, expected);
        EXPECT_EQ(counts.events(), expected_counts.events());
        EXPECT_EQ(counts.steps(), expected_counts.steps());
    }
}

Crowd crowd(decltype(testing::RayFamily::rays) rays, std::size_t count, Random& random) {
    return testing::crowd_of(count, rays, 40, random);
}

std::vector<double> events_by_level(const Crowd& crowd) {
    std::vector<double> events;
    for (std::size_t level = 0; std::size_t{1} << level <= crowd.rays.size(); ++level) {
        SweepCounts counts;
        sweep_groups_first_rectangles(level, crowd.rectangles, crowd.rays, &counts);
        events.push_back(static_cast<double>(counts.events()));
    }
    return events;
}

TEST(GroupedSweeps, TakeFewestStepsWhereThePaperSays) {
    Random random(5);
    for (const auto rays : {testing::sloped_rays_within, testing::nearly_parallel_rays}) {
        const std::vector<double> events = events_by_level(crowd(rays, 512, random));
        const auto least = std::min_element(events.begin(), events.end());
        EXPECT_GT(events.front(), 3 * *least) << "in one group rays cross";
        EXPECT_GT(events.back(), 1.2 * *least) << "of groups of one ray many are asked";
        const std::size_t stated = stated_level(512, 512);
        EXPECT_EQ(stated, 5U);
        EXPECT_LT(events.at(stated), 1.5 * *least);
    }
}

TEST(GroupedSweeps, TakeStepsForARayThatGrowNoFasterThanThePaperSays) {
    Random random(6);
    for (const auto family : {testing::sloped_rays_within, testing::nearly_parallel_rays}) {
        std::vector<double> sizes;
        std::vector<double> of_ray;
        // Trees of fewer nodes are undecided in all of them.
        for (std::size_t count = 512; count <= 8192; count *= 2) {
            const Crowd made = crowd(family, count, random);
            SweepCounts counts;
            sweep_groups_first_rectangles(
                stated_level(count, count), made.rectangles, made.rays, &counts);
            const auto m = static_cast<double>(count);
            sizes.push_back(m);
            of_ray.push_back(static_cast<double>(counts.events()) / m);
            EXPECT_LT(
                static_cast<double>(counts.steps()),
                std::log2(m) * std::log2(m) * static_cast<double>(counts.events()));
        }
        const Growth found = growth(sizes, of_ray);
        EXPECT_LT(found.exponent - found.uncertainty, 0.41);
        EXPECT_LT(found.uncertainty, 0.2) << "tells nothing";
    }
}

TEST(GroupedSweeps, AreChosenByTheCrossingsOfSomePairs) {
    Random random(7);
    for (const auto rays : {testing::sloped_rays_within, testing::nearly_parallel_rays}) {
        const Crowd made = crowd(rays, 512, random);
        const std::size_t level = sampled_level(made.rectangles, made.rays);
        const std::vector<double> events = events_by_level(made);
        EXPECT_LT(events.at(level), 2 * *std::min_element(events.begin(), events.end()));
        EXPECT_LT(events.at(level), events.front() / 2);
    }
    const Crowd pencil = crowd(testing::pencil_of_rays, 512, random);
    EXPECT_EQ(sampled_level(pencil.rectangles, pencil.rays), 0U) << "nothing crosses";
    EXPECT_EQ(sampled_level({}, pencil.rays), 0U);
    EXPECT_EQ(sampled_level(pencil.rectangles, {}), 0U);
}

TEST(GroupedSweeps, HaveTheStatedLevelWithinWhatThereIs) {
    EXPECT_EQ(stated_level(4096, 4096), 7U);
    EXPECT_EQ(stated_level(1 << 20, 1024), 0U) << "n = m^2";
    EXPECT_EQ(stated_level(1, 1024), 10U) << "no more groups than rays";
    EXPECT_EQ(stated_level(0, 10), 0U);
    EXPECT_EQ(stated_level(10, 0), 0U);
}

TEST(GroupedSweeps, AreRefusedBeforeMemoryRunsOut) {
    const Rectangles rectangles(3);
    const SlopedRays rays(200'000);
    const MemoryLimit little(1);
    try {
        sweep_groups_first_rectangles(4, rectangles, rays);
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(
            error.what(),
            ::testing::StartsWith("sweeps through 3 rectangles with 200000 rays takes about "));
    }
}

TEST(GroupedSweeps, TellHowFarTheyAreAndCanBeStopped) {
    Random random(10);
    const Rectangles rectangles = testing::rectangles_within(50, 1000, 50, random);
    const SlopedRays rays = testing::sloped_rays_within(100, 1000, 3, random);
    double last = 0;
    int calls = 0;
    sweep_groups_first_rectangles(6, rectangles, rays, nullptr, [&](double done) {
        EXPECT_GE(done, last);
        last = done;
        ++calls;
    });
    EXPECT_EQ(last, 1);
    EXPECT_GT(calls, 3);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(
        sweep_groups_first_rectangles(2, rectangles, rays, nullptr, {}, &cancel), Cancelled);
}

} // namespace
} // namespace vera
