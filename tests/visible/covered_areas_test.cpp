// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/brute_force.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/covered_areas.h"
#include "vera/visible/penetrations.h"

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

/// How often the outline goes round the point to the left.
int turns_about(const VisibleMap& map, const CoveredAreas::Outline& outline, double x, double y) {
    int turns = 0;
    for (const std::vector<std::uint32_t>& way : outline)
        for (std::size_t i = 0; i < way.size(); ++i) {
            const RationalPoint& a = map.vertices[map.ring_vertices[way[i]]];
            const RationalPoint& b = map.vertices[map.ring_vertices[way[(i + 1) % way.size()]]];
            const double side = (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
            if (a.y() <= y && b.y() > y && side > 0)
                ++turns;
            else if (a.y() > y && b.y() <= y && side < 0)
                --turns;
        }
    return turns;
}

/// Each point at which something is seen is in the area of that, once, and in no other; each other
/// point is in none.
void expect_like_brute_force(
    const ScreenScene& scene, std::uint64_t seed, const std::string& what) {
    const VisibleMap map = visible_map(scene, cell_raster(scene));
    const CoveredAreas areas = covered_areas(map);
    std::mt19937_64 random(seed);
    for (int i = 0; i < 60 && !::testing::Test::HasFailure(); ++i) {
        const auto x = static_cast<std::int64_t>(random() % (2 * std::uint64_t{screen_size})) | 1;
        const auto y = static_cast<std::int64_t>(random() % (2 * std::uint64_t{screen_size})) | 1;
        const SeenAt seen = seen_at(scene, x, y);
        if (seen.has_side_at)
            continue;
        for (std::uint32_t area = 0; area < areas.outlines.size(); ++area) {
            const bool is_here = seen.source != no_source && areas.of_source[seen.source] == area;
            EXPECT_EQ(
                turns_about(
                    map,
                    areas.outlines[area],
                    0.5 * static_cast<double>(x),
                    0.5 * static_cast<double>(y)),
                is_here ? 1 : 0)
                << what << " at " << x << " " << y << ", area " << area;
        }
        if (seen.source != no_source) {
            EXPECT_LT(areas.of_source[seen.source], areas.outlines.size()) << what;
        }
    }
}

TEST(CoveredAreas, AreWhereSomethingIsSeen) {
    for (std::uint64_t seed = 0; seed < 200 && !HasFailure(); ++seed)
        expect_like_brute_force(
            testing::layers(seed, 1 + seed % 20, std::int32_t{1} << (1 + seed % 5)),
            seed,
            "layers " + std::to_string(seed));
    for (std::uint64_t seed = 0; seed < 20 && !HasFailure(); ++seed)
        expect_like_brute_force(
            testing::scattered(seed, 100, screen_size >> (1 + seed % 4)),
            seed,
            "scattered " + std::to_string(seed));
}

TEST(CoveredAreas, HangTogetherWhereTheyHaveABorderInCommon) {
    ScreenScene scene;
    scene.vertices = {
        {{0, 0}, 5},
        {{100, 0}, 5},
        {{0, 100}, 5},
        {{100, 100}, 5},
        {{200, 100}, 5},
        {{200, 200}, 5}};
    add_triangle(scene, {0, 1, 2}, 1);
    add_triangle(scene, {1, 3, 2}, 2);
    // It touches them at a corner alone.
    add_triangle(scene, {3, 4, 5}, 4);
    const VisibleMap map = visible_map(scene, cell_raster(scene));
    const CoveredAreas areas = covered_areas(map);
    ASSERT_EQ(areas.outlines.size(), 2U);
    EXPECT_EQ(areas.of_source[1], 0U);
    EXPECT_EQ(areas.of_source[2], 0U);
    EXPECT_EQ(areas.of_source[4], 1U);
    std::size_t corners = 0;
    for (const CoveredAreas::Outline& outline : areas.outlines)
        for (const auto& way : outline)
            corners += way.size();
    EXPECT_EQ(corners, 4U + 3U);
    EXPECT_TRUE(covered_areas({}).outlines.empty());
}

} // namespace
} // namespace vera
