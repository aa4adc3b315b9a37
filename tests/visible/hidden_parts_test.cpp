// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/brute_force.h"
#include "vera/visible/hidden_parts.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

struct Place {
    double x = 0;
    double y = 0;
};

/// Whether different things are seen on both sides of the edge around a place of it, by asking
/// every triangle; nothing where something else is near. Lengths are in half steps.
std::optional<bool> is_line_seen_at(const ScreenScene& scene, Place place, ScreenStep along) {
    const double length = std::hypot(along.x, along.y);
    const double x = static_cast<double>(along.x) / length;
    const double y = static_cast<double>(along.y) / length;
    std::array<std::optional<std::uint32_t>, 2> sides;
    for (const double off : {3.0, 9.0, 24.0})
        for (const int side : {0, 1})
            for (const double on : {-12.0, 0.0, 12.0}) {
                const double away = side == 0 ? off : -off;
                const SeenAt seen = seen_at(
                    scene,
                    std::llround(2 * place.x + on * x - away * y) | 1,
                    std::llround(2 * place.y + on * y + away * x) | 1);
                auto& source = sides[static_cast<std::size_t>(side)];
                if (seen.has_side_at || (source && *source != seen.source))
                    return std::nullopt;
                source = seen.source;
            }
    return sides[0] != sides[1];
}

/// Whether one of the parts, on the same line of the picture, holds the place.
bool is_in_parts(
    const ScreenScene& scene,
    const ScreenEdges& edges,
    const std::vector<HiddenPart>& parts,
    const ScreenEdges::Edge& edge,
    Place place) {
    const ScreenPoint a = scene.vertices[edge.begin].point;
    const ScreenPoint b = scene.vertices[edge.end].point;
    int found = 0;
    for (const HiddenPart& part : parts) {
        const ScreenEdges::Edge& other = edges.edges[part.edge];
        if (orientation(a, b, scene.vertices[other.begin].point) != 0
            || orientation(a, b, scene.vertices[other.end].point) != 0)
            continue;
        const auto along = [&](double x, double y) {
            return (x - a.x) * (b.x - a.x) + (y - a.y) * (b.y - a.y);
        };
        const double from = along(part.from.x(), part.from.y());
        const double to = along(part.to.x(), part.to.y());
        const double at = along(place.x, place.y);
        found += std::min(from, to) < at && at < std::max(from, to) ? 1 : 0;
    }
    EXPECT_LE(found, 1); // where edges lie upon each other there is one part
    return found > 0;
}

int compare_with_brute_force(const ScreenScene& scene, std::uint64_t seed) {
    const VisiblePieces pieces = cell_raster(scene);
    const ScreenEdges edges = screen_edges(scene);
    std::vector<std::uint32_t> drawn(edges.edges.size());
    std::iota(drawn.begin(), drawn.end(), 0U);
    const std::vector<HiddenPart> parts = hidden_parts(scene, edges, drawn, pieces);
    std::mt19937_64 random(seed);
    int compared = 0;
    for (int i = 0; i < 100; ++i) {
        const ScreenEdges::Edge& edge = edges.edges[random() % edges.edges.size()];
        const ScreenPoint a = scene.vertices[edge.begin].point;
        const ScreenPoint b = scene.vertices[edge.end].point;
        const double part = std::uniform_real_distribution(0.01, 0.99)(random);
        const Place place = {a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)};
        const auto seen = is_line_seen_at(scene, place, step(a, b));
        if (!seen)
            continue;
        ++compared;
        EXPECT_EQ(is_in_parts(scene, edges, parts, edge, place), !*seen)
            << "seed " << seed << " at " << place.x << ' ' << place.y;
    }
    return compared;
}

TEST(HiddenParts, AreWhatBruteForceDoesNotSeeOfLayersOnFewPoints) {
    int compared = 0;
    for (std::uint64_t seed = 0; seed < 200 && !HasFailure(); ++seed)
        compared += compare_with_brute_force(
            testing::layers(seed, 3 + seed % 40, seed % 2 == 0 ? 4 : 9), seed);
    EXPECT_GT(compared, 8000);
}

TEST(HiddenParts, AreWhatBruteForceDoesNotSeeOfScatteredTriangles) {
    int compared = 0;
    for (std::uint64_t seed = 0; seed < 10 && !HasFailure(); ++seed)
        compared += compare_with_brute_force(testing::scattered(seed, 150, screen_size / 4), seed);
    EXPECT_GT(compared, 700);
}

TEST(HiddenParts, AreOfEachEdgeThatIsAskedForAlone) {
    // A triangle before another, and both before a third with a side on the same line.
    ScreenScene scene;
    const std::int32_t unit = 1000;
    const std::int32_t height = 10 * unit; // of the line
    const auto add = [&](std::array<ScreenPoint, 3> corners, std::int64_t nearness) {
        const auto first = static_cast<std::uint32_t>(scene.vertices.size());
        for (const ScreenPoint corner : corners)
            scene.vertices.push_back({{corner.x * unit, corner.y * unit}, nearness});
        add_triangle(scene, {first, first + 1, first + 2}, first / 3);
    };
    add({{{2, 9}, {6, 9}, {4, 13}}}, 3'000'000);
    add({{{0, 10}, {8, 10}, {4, 0}}}, 2'000'000);
    add({{{1, 10}, {12, 10}, {4, 4}}}, 1'000'000);
    const VisiblePieces pieces = cell_raster(scene);
    const ScreenEdges edges = screen_edges(scene);
    std::vector<std::uint32_t> drawn;
    for (std::uint32_t i = 0; i < edges.edges.size(); ++i) {
        const ScreenPoint a = scene.vertices[edges.edges[i].begin].point;
        if (a.y == height && scene.vertices[edges.edges[i].end].point.y == height)
            drawn.push_back(i);
    }
    ASSERT_EQ(drawn.size(), 2U);
    const std::vector<HiddenPart> parts = hidden_parts(scene, edges, drawn, pieces);
    // From 2.5 to 5.5 behind the first; up to 12 the line is seen.
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_EQ(parts[0].from, (RationalPoint{{5 * unit / 2, height}}));
    EXPECT_EQ(parts[0].to, (RationalPoint{{11 * unit / 2, height}}));
    EXPECT_TRUE(hidden_parts(scene, edges, {}, pieces).empty());
    const std::vector<HiddenPart> all = hidden_parts(scene, edges, drawn, {});
    ASSERT_EQ(all.size(), 2U); // one behind the other, and not twice where both are
    EXPECT_EQ(all[0].from, (RationalPoint{{0, height}}));
    EXPECT_EQ(all[0].to, all[1].from);
    EXPECT_EQ(all[1].to, (RationalPoint{{12 * unit, height}}));
}

} // namespace
} // namespace vera
