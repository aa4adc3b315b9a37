// SPDX-License-Identifier: Apache-2.0
#include "vera/base/random.h"
#include "vera/visible/open_points.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "visible/map_turns.h"
#include "visible/maximal_pieces.h"
#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::area_of;
using testing::layers;
using testing::scattered;
using testing::tangle;

/// A tangle with corners on few crossings and depths of a few values, so that some of it lies in
/// one plane, in front of a sheet that fills the picture, cut where it passes through itself.
ScreenScene cut_before_a_sheet(std::uint64_t seed) {
    ScreenScene scene = tangle(seed, 4 + seed % 20, 6);
    for (ScreenVertex& vertex : scene.vertices)
        vertex.nearness = depth_size / 4 + (vertex.nearness * 3 / depth_size) * (depth_size / 8);
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    for (const ScreenPoint corner :
         {ScreenPoint{0, 0}, {screen_size, 0}, {screen_size, screen_size}, {0, screen_size}})
        scene.vertices.push_back({corner, 0});
    add_triangle(scene, {first, first + 1, first + 2}, 1000);
    add_triangle(scene, {first, first + 2, first + 3}, 1000);
    return scene;
}

TEST(VisibleMap, HasTheAreaOfThePictureAlsoWhereWaysAreJoined) {
    std::size_t joined = 0;
    for (std::uint64_t seed = 1200; seed < 1400; ++seed) {
        ScreenScene scene = cut_before_a_sheet(seed);
        const WholePieces whole = whole_pieces(scene);
        EXPECT_EQ(whole.left, 0U) << seed;
        const VisibleMap map = visible_map(scene, whole.pieces);
        joined += map.joined_sides.size();
        // What three surfaces leave between them is a few steps wide.
        EXPECT_NEAR(area_of(map), std::ldexp(1.0, 2 * screen_bits), 64.0 * screen_size) << seed;
        EXPECT_LE(map.longest_join, short_way) << seed;
    }
    EXPECT_GT(joined, 50U);
}

TEST(VisibleMap, IsThePictureWhereTheOrderOfThreeGoesRound) {
    // Neighbours told different fronts there, and ways were joined across half the picture.
    for (const std::uint64_t seed : {94U, 3314U, 6934U})
        for (const auto engine : {VisibilityEngine::cells, VisibilityEngine::sweep}) {
            ScreenScene scene = cut_before_a_sheet(seed);
            const WholePieces whole = whole_pieces(scene, {}, nullptr, engine);
            EXPECT_EQ(whole.left, 0U) << seed;
            EXPECT_GT(whole.opened, 0U) << seed;
            EXPECT_TRUE(open_points(scene, whole.pieces).empty()) << seed;
            const VisibleMap map = visible_map(scene, whole.pieces);
            EXPECT_NEAR(area_of(map), std::ldexp(1.0, 2 * screen_bits), 64.0 * screen_size) << seed;
            EXPECT_LE(map.longest_join, short_way) << seed;
        }
}

TEST(OpenPoints, AreThoseAtWhichWaysEnd) {
    const ScreenScene scene = scattered(3, 40, screen_size / 2);
    const VisiblePieces whole = cell_raster(scene);
    EXPECT_TRUE(open_points(scene, whole, 0).empty());
    std::mt19937_64 random(5);
    for (int round = 0; round < 200; ++round) {
        VisiblePieces pieces = whole;
        const std::size_t one = random() % pieces.pieces.size();
        const VisiblePiece gone = pieces.pieces[one];
        pieces.pieces.erase(pieces.pieces.begin() + static_cast<std::ptrdiff_t>(one));
        std::vector<std::uint32_t> ends = {gone.from, gone.to};
        std::sort(ends.begin(), ends.end());
        std::vector<PackedPoint> expected;
        for (const std::uint32_t end : ends)
            expected.push_back(pieces.points[end]);
        std::vector<PackedPoint> found = open_points(scene, pieces, 0);
        ASSERT_EQ(found.size(), 2U);
        if (!(found[0] == expected[0]))
            std::swap(found[0], found[1]);
        EXPECT_TRUE(found == expected);
        // Both ends do where they are near each other.
        const double length = std::max(
            std::abs(expected[0].x() - expected[1].x()),
            std::abs(expected[0].y() - expected[1].y()));
        EXPECT_TRUE(open_points(scene, pieces, length).empty());
        EXPECT_EQ(open_points(scene, pieces, 0.5 * length).size(), 2U);
    }
}

/// Where many pieces are gone, as told by comparing each open point with each other one.
TEST(OpenPoints, AreLeftWhereGroupsWithinReachDoNotClose) {
    std::mt19937_64 random(16);
    std::size_t left = 0;
    std::size_t closed = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const ScreenScene scene = layers(seed, 4 + seed % 20, std::int32_t{1} << (2 + seed % 4));
        VisiblePieces pieces = cell_raster(scene);
        std::erase_if(pieces.pieces, [&](const VisiblePiece&) { return random() % 4 == 0; });
        const auto source = [&](std::uint32_t triangle) {
            return scrambled_bits(
                triangle == no_triangle ? no_source : scene.triangles[triangle].source);
        };
        std::vector<std::uint64_t> sums(pieces.points.size());
        for (const VisiblePiece& piece : pieces.pieces) {
            sums[piece.from] += source(piece.left) - source(piece.right);
            sums[piece.to] -= source(piece.left) - source(piece.right);
        }
        std::vector<std::size_t> open;
        for (std::size_t i = 0; i < sums.size(); ++i)
            if (sums[i] != 0)
                open.push_back(i);
        for (const double reach : {0.0, 3.0, screen_size / 64.0, screen_size / 8.0}) {
            // A point has the least number of those that it is joined to.
            std::vector<std::size_t> group(open.size());
            for (std::size_t i = 0; i < group.size(); ++i)
                group[i] = i;
            for (bool changes = true; changes;) {
                changes = false;
                for (std::size_t i = 0; i < open.size(); ++i)
                    for (std::size_t j = 0; j < open.size(); ++j) {
                        const PackedPoint& a = pieces.points[open[i]];
                        const PackedPoint& b = pieces.points[open[j]];
                        if (group[j] < group[i] && std::abs(a.x() - b.x()) <= reach
                            && std::abs(a.y() - b.y()) <= reach) {
                            group[i] = group[j];
                            changes = true;
                        }
                    }
            }
            std::vector<std::uint64_t> sum_of(open.size());
            for (std::size_t i = 0; i < open.size(); ++i)
                sum_of[group[i]] += sums[open[i]];
            std::vector<std::pair<double, double>> expected;
            for (std::size_t i = 0; i < open.size(); ++i)
                if (sum_of[group[i]] != 0)
                    expected.emplace_back(pieces.points[open[i]].x(), pieces.points[open[i]].y());
            std::vector<std::pair<double, double>> found;
            for (const PackedPoint& point : open_points(scene, pieces, reach))
                found.emplace_back(point.x(), point.y());
            std::sort(expected.begin(), expected.end());
            std::sort(found.begin(), found.end());
            EXPECT_TRUE(found == expected) << "seed " << seed << " reach " << reach;
            left += found.size();
            closed += open.size() - found.size();
        }
    }
    EXPECT_GT(left, 1000U);
    EXPECT_GT(closed, 100U);
}

/// Where the order of triangles goes round nowhere, what is hidden makes no difference.
TEST(VisiblePieces, AmongAllAreThoseFoundWithoutWhatIsHidden) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const ScreenScene scene = layers(seed, 2 + seed % 30, std::int32_t{1} << (1 + seed % 4));
        const VisiblePieces found = cell_raster(scene);
        std::vector<PackedPoint> near;
        for (std::size_t i = 0; i < found.points.size(); i += 1 + seed % 5)
            near.push_back(found.points[i]);
        const VisiblePieces again = cell_raster_after({{}, {}, near}, near, found, scene);
        EXPECT_TRUE(again.penetrating.empty()) << seed;
        EXPECT_TRUE(testing::maximal_pieces(scene, again) == testing::maximal_pieces(scene, found))
            << seed;
    }
}

} // namespace
} // namespace vera
