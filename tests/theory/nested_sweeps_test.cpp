// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/grouped_sweeps.h"
#include "vera/theory/growth.h"
#include "vera/theory/nested_sweeps.h"

#include <cmath>
#include <random>
#include <vector>

#include "theory/rectangles.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using Random = std::mt19937_64;
using testing::Crowd;
using testing::Rectangles;
using testing::SlopedRays;

TEST(NestedSweeps, FindTheRectanglesThatLookingAtEachFindsAtEveryLevel) {
    Random random(1988);
    std::size_t asked = 0;
    for (int round = 0; round < 30; ++round)
        for (const testing::RayFamily& family : testing::ray_families()) {
            const Rectangles rectangles = round % 5 == 0
                ? testing::repeated_rectangles(25, random)
                : testing::rectangles_within(random() % 40, 6, round % 3 == 0 ? 2 : 12, random);
            const std::size_t count = random() % 100;
            const SlopedRays rays = family.rays(count, 7, 2, random);
            const FirstRectangles expected = brute_force_first_rectangles(rectangles, rays);
            for (const std::size_t level : {0U, 1U, 2U, 4U, 7U}) {
                ASSERT_EQ(nested_sweeps_first_rectangles(level, rectangles, rays), expected)
                    << family.name << ", level " << level;
                ASSERT_EQ(
                    nested_sweeps_first_rectangles(
                        level, rectangles, rays, nullptr, {}, nullptr, TreeKind::optimal),
                    expected)
                    << family.name << ", level " << level << ", trees of today";
                asked += 2 * rays.size();
            }
        }
    EXPECT_GT(asked, 40000U);
}

Crowd crowd(std::size_t count, Random& random) {
    return testing::crowd_of(count, testing::sloped_rays_within, 3, random);
}

double events(std::size_t level, const Crowd& crowd) {
    NestedSweepCounts counts;
    nested_sweeps_first_rectangles(level, crowd.rectangles, crowd.rays, &counts);
    return static_cast<double>(counts.sweeps.events() + counts.trees.nodes);
}

TEST(NestedSweeps, TakeFewestStepsWhereThePaperSays) {
    Random random(5);
    const Crowd made = crowd(512, random);
    const double stated = events(stated_level(512, 512), made);
    EXPECT_GT(events(0, made), 4 * stated) << "one sweep of all";
    EXPECT_GT(events(1, made), 1.5 * stated);
    EXPECT_GT(events(9, made), 1.05 * stated) << "trees down to single rays";
}

TEST(NestedSweeps, TakeStepsForARayThatGrowNoFasterThanThePaperSays) {
    Random random(6);
    std::vector<double> sizes;
    std::vector<double> of_ray;
    for (std::size_t count = 256; count <= 4096; count *= 2) {
        const Crowd made = crowd(count, random);
        sizes.push_back(static_cast<double>(count));
        of_ray.push_back(events(stated_level(count, count), made) / static_cast<double>(count));
    }
    const Growth found = growth(sizes, of_ray);
    EXPECT_LT(found.exponent - found.uncertainty, 0.41);
    EXPECT_LT(found.uncertainty, 0.25) << "tells nothing";
}

TEST(NestedSweeps, TellHowFarTheyAreAndCanBeStopped) {
    Random random(10);
    const Crowd made = crowd(100, random);
    double last = 0;
    nested_sweeps_first_rectangles(3, made.rectangles, made.rays, nullptr, [&](double done) {
        EXPECT_GE(done, last);
        last = done;
    });
    EXPECT_EQ(last, 1);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(
        nested_sweeps_first_rectangles(3, made.rectangles, made.rays, nullptr, {}, &cancel),
        Cancelled);
}

} // namespace
} // namespace vera
