// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/kinetic_range_tree.h"

#include <algorithm>
#include <random>
#include <vector>

#include "theory/rectangles.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using Numbers = std::vector<std::uint32_t>;

/// Every node has, by the order of y, the rays that were added and stand at its places: what
/// looking at each ray tells.
void expect_nodes_hold_their_rays(const KineticRangeTree& tree, const Numbers& added) {
    tree.for_each_node([&](std::size_t first, std::size_t last, const auto& rays) {
        Numbers expected;
        for (const std::uint32_t ray : added) {
            const std::size_t place = tree.x_order().place(ray);
            if (first <= place && place < last)
                expected.push_back(ray);
        }
        std::sort(expected.begin(), expected.end(), [&](std::uint32_t a, std::uint32_t b) {
            return tree.y_order().place(a) < tree.y_order().place(b);
        });
        ASSERT_EQ(Numbers(rays.begin(), rays.end()), expected);
    });
}

void expect_answers(
    KineticRangeTree& tree,
    const testing::SlopedRays& rays,
    const Numbers& added,
    const IsoRectangle& rectangle) {
    Numbers met;
    tree.append_met(rectangle, met);
    std::sort(met.begin(), met.end());
    Numbers expected;
    for (const std::uint32_t ray : added) {
        SlopedRay line = rays[ray];
        line.first_z = -largest_plane_coordinate;
        if (meets(line, rectangle))
            expected.push_back(ray);
    }
    std::sort(expected.begin(), expected.end());
    ASSERT_EQ(met, expected);
}

TEST(KineticRangeTree, HoldsWhatLookingAtEachRayTellsAfterEveryEvent) {
    std::mt19937_64 random(1988);
    std::size_t events = 0;
    for (int round = 0; round < 60; ++round)
        for (const testing::RayFamily& family : testing::ray_families()) {
            const auto rays = family.rays(1 + random() % 64, 6, 3, random);
            SweepCounts counts;
            KineticRangeTree tree(rays, -6, 6, counts);
            Numbers added;
            Numbers waiting(rays.size());
            for (std::uint32_t ray = 0; ray < rays.size(); ++ray)
                waiting[ray] = ray;
            for (std::int32_t z = -6; z <= 6; ++z) {
                while (tree.pass_crossing(z)) {
                    ++events;
                    expect_nodes_hold_their_rays(tree, added);
                }
                Numbers begun;
                for (std::uint64_t i = random() % 12; i > 0 && !waiting.empty(); --i) {
                    const std::uint32_t ray = waiting.back();
                    waiting.pop_back();
                    if (random() % 5 == 0)
                        tree.remove(ray); // before it was added
                    else
                        begun.push_back(ray);
                }
                tree.add(begun);
                added.insert(added.end(), begun.begin(), begun.end());
                expect_nodes_hold_their_rays(tree, added);
                for (IsoRectangle rectangle : testing::rectangles_within(4, 8, 9, random)) {
                    rectangle.z = z;
                    expect_answers(tree, rays, added, rectangle);
                }
                for (std::uint64_t i = random() % 4; i > 0 && !added.empty(); --i) {
                    const std::size_t which = random() % added.size();
                    tree.remove(added[which]);
                    added.erase(added.begin() + static_cast<std::ptrdiff_t>(which));
                    expect_nodes_hold_their_rays(tree, added);
                }
                if (HasFatalFailure())
                    return;
            }
            EXPECT_EQ(counts.x_swaps, tree.x_order().passed());
            EXPECT_EQ(counts.y_swaps, tree.y_order().passed());
        }
    EXPECT_GT(events, 10000U);
}

TEST(KineticRangeTree, AnswersNothingWithoutRays) {
    SweepCounts counts;
    KineticRangeTree tree({}, 0, 1, counts);
    EXPECT_FALSE(tree.pass_crossing(1));
    Numbers met;
    tree.append_met({}, met);
    EXPECT_TRUE(met.empty());
}

} // namespace
} // namespace vera
