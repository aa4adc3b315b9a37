// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/drawn_faces.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/piece_lists.h"
#include "vera/visible/plane_sweep.h"
#include "vera/visible/projection.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "accel/random_scene.h"
#include "visible/maximal_pieces.h"
#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::maximal_pieces;

void expect_same_maps(const VisibleMap& a, const VisibleMap& b, const std::string& what) {
    ASSERT_EQ(a.rings.size(), b.rings.size()) << what;
    EXPECT_EQ(a.joined, b.joined) << what;
    for (std::size_t i = 0; i < a.rings.size(); ++i) {
        const auto& one = a.rings[i];
        const auto& other = b.rings[i];
        ASSERT_EQ(one.source, other.source) << what;
        ASSERT_EQ(one.count, other.count) << what;
        for (std::size_t j = 0; j < one.count; ++j) {
            EXPECT_EQ(a.vertices[a.vertices_of(one)[j]], b.vertices[b.vertices_of(other)[j]])
                << what;
            EXPECT_EQ(a.ring_across[one.first + j], b.ring_across[other.first + j]) << what;
        }
    }
}

/// Number for number, where edges are parted only by what is seen.
void expect_same_pieces(VisiblePieces by_cells, VisiblePieces by_sweep, const std::string& what) {
    join_along_edges(by_cells);
    join_along_edges(by_sweep);
    EXPECT_TRUE(by_cells.points == by_sweep.points) << what;
    EXPECT_TRUE(std::ranges::equal(
        by_cells.pieces,
        by_sweep.pieces,
        [](const VisiblePiece& a, const VisiblePiece& b) {
            return a.from == b.from && a.to == b.to && a.edge == b.edge && a.left == b.left
                && a.right == b.right;
        }))
        << what;
}

void expect_same(const ScreenScene& scene, const std::string& what) {
    const VisiblePieces by_cells = cell_raster(scene);
    const VisiblePieces by_sweep = plane_sweep(scene);
    EXPECT_EQ(by_cells.penetrating, by_sweep.penetrating) << what;
    const auto expected = maximal_pieces(scene, by_cells);
    const auto found = maximal_pieces(scene, by_sweep);
    EXPECT_EQ(expected.size(), found.size()) << what;
    EXPECT_TRUE(expected == found) << what;
    expect_same_maps(visible_map(scene, by_sweep), visible_map(scene, by_cells), what);
    expect_same_pieces(by_cells, by_sweep, what);
}

TEST(PlaneSweep, SeesLikeTheCellsWhatLiesInLayersOnFewPoints) {
    for (std::uint64_t seed = 0; seed < 400 && !HasFailure(); ++seed)
        expect_same(
            testing::layers(seed, 1 + seed % 60, std::int32_t{1} << (1 + seed % 4)),
            "seed " + std::to_string(seed));
}

TEST(PlaneSweep, SeesLikeTheCellsWhatIsScattered) {
    for (std::uint64_t seed = 0; seed < 12 && !HasFailure(); ++seed)
        expect_same(
            testing::scattered(seed, 400, screen_size >> (seed % 6)),
            "seed " + std::to_string(seed));
    // So small that much shares its corners and sides.
    for (std::uint64_t seed = 0; seed < 100 && !HasFailure(); ++seed) {
        ScreenScene scene = testing::scattered(seed, 60, 8);
        for (ScreenVertex& vertex : scene.vertices)
            vertex.point = {vertex.point.x % 12, vertex.point.y % 12};
        ScreenScene moved;
        moved.vertices = scene.vertices;
        for (const ScreenTriangle& triangle : scene.triangles)
            add_triangle(moved, triangle.vertices, triangle.source);
        expect_same(moved, "seed " + std::to_string(seed));
    }
}

TEST(PlaneSweep, SeesLikeTheCellsATerrain) {
    for (std::uint64_t seed = 0; seed < 6 && !HasFailure(); ++seed)
        expect_same(testing::terrain(seed, 4 << (seed % 4)), "seed " + std::to_string(seed));
}

TEST(PlaneSweep, SeesLikeTheCellsAStarAndSliversAndNestedHoles) {
    expect_same(testing::star(500), "star");
    for (std::int32_t count = 1; count < 20; ++count)
        expect_same(testing::nested_holes(count), "holes " + std::to_string(count));
    for (std::uint64_t seed = 0; seed < 200 && !HasFailure(); ++seed)
        expect_same(testing::slivers(seed, 2 + seed % 30), "seed " + std::to_string(seed));
}

TEST(PlaneSweep, SeesLikeTheCellsWhatLiesInOnePlane) {
    for (std::uint64_t seed = 0; seed < 200 && !HasFailure(); ++seed) {
        ScreenScene scene = testing::layers(seed, 2 + seed % 30, std::int32_t{1} << (1 + seed % 3));
        for (ScreenVertex& vertex : scene.vertices)
            vertex.nearness = seed % 2 == 0 ? 5 : std::int64_t{vertex.point.x} + 2 * vertex.point.y;
        expect_same(scene, "seed " + std::to_string(seed));
    }
}

TEST(PlaneSweep, SeesLikeTheCellsWhatIsSoCloseThatTheOrderIsNotTransitive) {
    // Two planes two depths apart are coincident, so that the first of the text is in front; four
    // apart they are not: a may be before b, b before c and c before a.
    for (std::uint64_t seed = 0; seed < 300 && !HasFailure(); ++seed) {
        ScreenScene scene = testing::layers(seed, 2 + seed % 40, std::int32_t{1} << (1 + seed % 4));
        for (const ScreenTriangle& triangle : scene.triangles)
            for (const std::uint32_t i : triangle.vertices) {
                ScreenVertex& vertex = scene.vertices[i];
                vertex.nearness = 1000 + triangle.source % 7
                    + (seed % 2 == 0 ? 0 : vertex.point.x + 3 * std::int64_t{vertex.point.y});
            }
        expect_same(scene, "seed " + std::to_string(seed));
    }
}

/// Lets each triangle have another one of its source beside its first side, or folded onto it.
void double_sources(std::uint64_t seed, ScreenScene& scene) {
    const std::size_t count = scene.triangles.size();
    for (std::size_t i = 0; i < count; ++i) {
        const ScreenTriangle triangle = scene.triangles[i];
        const ScreenVertex& other = scene.vertices[(i * 7 + seed) % scene.vertices.size()];
        const std::int64_t nearness = scene.vertices[triangle.vertices[0]].nearness;
        const ScreenVertex corner = {other.point, nearness};
        const auto number = static_cast<std::uint32_t>(scene.vertices.size());
        scene.vertices.push_back(corner);
        add_triangle(scene, {triangle.vertices[1], triangle.vertices[0], number}, triangle.source);
    }
}

TEST(PlaneSweep, SeesLikeTheCellsSourcesOfSeveralTriangles) {
    for (std::uint64_t seed = 0; seed < 300 && !HasFailure(); ++seed) {
        ScreenScene scene = testing::layers(seed, 1 + seed % 40, std::int32_t{1} << (1 + seed % 4));
        double_sources(seed, scene);
        expect_same(scene, "layers, seed " + std::to_string(seed));
    }
    // Patches of a terrain that are wider than cells, behind a few triangles.
    for (std::uint64_t seed = 0; seed < 40 && !HasFailure(); ++seed) {
        ScreenScene scene = testing::terrain(seed, 4 << (seed % 4));
        for (ScreenVertex& vertex : scene.vertices)
            vertex.nearness /= 2;
        for (ScreenTriangle& triangle : scene.triangles)
            triangle.source /= static_cast<std::uint32_t>(1 + 16 * (seed % 5));
        const ScreenScene before = testing::scattered(seed, seed % 9, screen_size / 4);
        const auto first = static_cast<std::uint32_t>(scene.vertices.size());
        const auto sources = static_cast<std::uint32_t>(scene.triangles.size());
        for (const ScreenVertex& vertex : before.vertices)
            scene.vertices.push_back({vertex.point, depth_size / 2 + vertex.nearness / 2});
        for (const ScreenTriangle& triangle : before.triangles) {
            const auto& [a, b, c] = triangle.vertices;
            add_triangle(scene, {first + a, first + b, first + c}, sources + triangle.source);
        }
        expect_same(scene, "terrain, seed " + std::to_string(seed));
    }
}

TEST(PlaneSweep, SeesLikeTheCellsNothingAndOneTriangle) {
    expect_same({}, "nothing");
    ScreenScene scene;
    scene.vertices = {{{0, 0}, 5}, {{screen_size, 0}, 5}, {{0, screen_size}, 5}};
    add_triangle(scene, {0, 1, 2}, 4);
    expect_same(scene, "one");
    EXPECT_EQ(plane_sweep(scene).pieces.size(), 3U);
}

TEST(PlaneSweep, SeesLikeTheCellsTanglesAfterCutting) {
    for (std::uint64_t seed = 0; seed < 150 && !HasFailure(); ++seed) {
        const std::string what = "seed " + std::to_string(seed);
        ScreenScene scene = testing::tangle(seed, 2 + seed % 30, seed % 3 == 0 ? 8 : 0);
        const WholePieces whole = whole_pieces(
            scene, {}, nullptr, seed % 2 == 0 ? VisibilityEngine::cells : VisibilityEngine::sweep);
        EXPECT_EQ(whole.left, 0U) << what;
        expect_same(scene, what);
    }
}

TEST(PlaneSweep, TellsLikeTheCellsWhatPenetrates) {
    for (std::uint64_t seed = 0; seed < 250; ++seed) {
        const ScreenScene scene = testing::tangle(seed, 2 + seed % 30);
        EXPECT_EQ(plane_sweep(scene).penetrating, cell_raster(scene).penetrating)
            << "seed " << seed;
    }
}

TEST(PlaneSweep, TellsLikeTheCellsWhatPenetratesThePairsOfAFoldedSurface) {
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        // Both of a pair have a side in common: what passes through one there meets the other at
        // the same place.
        ScreenScene scene = testing::tangle(seed, 2 + seed % 20);
        const std::size_t count = scene.triangles.size();
        for (std::size_t i = 0; i < count; ++i) {
            const auto& [a, b, c] = scene.triangles[i].vertices;
            const auto third = static_cast<std::uint32_t>((c + 3 * seed + 3) % (3 * count));
            add_triangle(scene, {a, b, third}, static_cast<std::uint32_t>(count + i));
        }
        EXPECT_EQ(plane_sweep(scene).penetrating, cell_raster(scene).penetrating)
            << "seed " << seed;
    }
}

/// What is seen of each source, but for a border of a few steps.
void expect_same_areas(const VisibleMap& a, const VisibleMap& b, const std::string& what) {
    std::map<std::uint32_t, double> difference;
    for (const VisibleMap::Ring& ring : a.rings)
        difference[ring.source] += 0.5 * doubled_area(a, ring);
    for (const VisibleMap::Ring& ring : b.rings)
        difference[ring.source] -= 0.5 * doubled_area(b, ring);
    for (const auto& [source, area] : difference)
        EXPECT_NEAR(area, 0, 4.0 * screen_size) << what << " source " << source;
}

TEST(PlaneSweep, SeesLikeTheCellsWholeScenes) {
    int identical = 0;
    for (int number = 0; number < 20; ++number) {
        testing::RandomSceneSettings settings;
        settings.items = 8 + static_cast<std::size_t>(number) % 3 * 6;
        const Scene scene = testing::random_scene(static_cast<std::uint64_t>(number), settings);
        Camera camera;
        camera.viewpoint = {3, 5.0 + number, 7};
        camera.direction = normalized(-camera.viewpoint);
        const Vec3 across = normalized(cross(camera.direction, {0.1, 0.2, 1}));
        const Vec3 up = cross(across, camera.direction);
        camera.lower_left = -5 * across - 5 * up;
        camera.lower_right = 5 * across - 5 * up;
        camera.upper_left = 5 * up - 5 * across;
        const CameraMap map(camera);
        const Facets all = facets(scene, [](Vec3) { return 0.02; });
        const DrawnFaces faces = drawn_faces(scene, all, FaceUnit::plane, camera);
        ScreenScene screen = screen_scene(all, map, faces.of_facet);
        sort_by_place(screen);
        ScreenScene again = screen;
        const WholePieces whole = whole_pieces(screen);
        const WholePieces swept = whole_pieces(again, {}, nullptr, VisibilityEngine::sweep);
        const std::string what = "scene " + std::to_string(number);
        EXPECT_GT(whole.pieces.pieces.size(), 0U) << what;
        const VisibleMap by_sweep = visible_map(again, swept.pieces);
        const VisibleMap by_cells = visible_map(screen, whole.pieces);
        // Where ways were open or had to be joined, surfaces are as near as each other within
        // rounding: what is in front beside a part of an edge is then a matter of how long the
        // part is, and so are the places near which all is asked again.
        if (by_sweep.joined + by_cells.joined + whole.opened + swept.opened != 0) {
            expect_same_areas(by_sweep, by_cells, what);
            continue;
        }
        ++identical;
        EXPECT_EQ(whole.rounds, swept.rounds) << what;
        EXPECT_TRUE(maximal_pieces(screen, whole.pieces) == maximal_pieces(again, swept.pieces))
            << what;
        expect_same_maps(by_sweep, by_cells, what);
    }
    EXPECT_GE(identical, 3);
}

TEST(PlaneSweep, RefusesWhatMemoryWouldNotHold) {
    const ScreenScene scene = testing::scattered(1, 400, screen_size / 2);
    PlaneSweepCounts counts;
    plane_sweep(scene, {std::nullopt, &counts});
    const SweepForecast forecast = sweep_forecast(scene);
    // Of so few edges all pairs are asked.
    EXPECT_EQ(forecast.crossings, static_cast<double>(counts.crossings));
    EXPECT_GT(counts.crossings, 1000U);
    const auto bytes = static_cast<std::uint64_t>(forecast.bytes);
    EXPECT_NO_THROW(plane_sweep(scene, {bytes + 1, nullptr}));
    try {
        plane_sweep(scene, {bytes - 1, nullptr});
        FAIL();
    } catch (const std::runtime_error& error) {
        const std::string message = error.what();
        const std::string crossings = std::to_string(counts.crossings) + " crossings of edges";
        EXPECT_NE(message.find(crossings), std::string::npos) << message;
        EXPECT_NE(message.find("--engine cells"), std::string::npos) << message;
    }
}

TEST(PlaneSweep, ForecastsFromSomePairsHowManyCrossingsThereAre) {
    const ScreenScene scene = testing::scattered(2, 3000, screen_size / 4);
    PlaneSweepCounts counts;
    plane_sweep(scene, {std::nullopt, &counts});
    EXPECT_NEAR(sweep_forecast(scene).crossings / static_cast<double>(counts.crossings), 1, 0.1);
}

TEST(PlaneSweep, EndsWhenItIsCancelledAndTellsHowFarItIs) {
    const ScreenScene scene = testing::scattered(1, 400, screen_size / 2);
    double last = 0;
    int told = 0;
    plane_sweep(scene, {}, [&](double done) {
        EXPECT_GE(done, last);
        EXPECT_LE(done, 1);
        last = done;
        ++told;
    });
    EXPECT_GT(told, 10);
    EXPECT_GT(last, 0.9);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(plane_sweep(scene, {}, {}, &cancel), Cancelled);
}

} // namespace
} // namespace vera
