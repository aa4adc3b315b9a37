// SPDX-License-Identifier: Apache-2.0
#include "vera/base/diagnostic.h"
#include "vera/base/random.h"
#include "vera/theory/ground_order.h"
#include "vera/theory/growth.h"
#include "vera/theory/terrain_view.h"
#include "vera/visible/brute_force.h"
#include "vera/visible/plane_sweep.h"
#include "vera/visible/projection.h"
#include "vera/visible/triangle_order.h"
#include "vera/visible/visible_map.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "theory/terrains.h"
#include "visible/maximal_pieces.h"
#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::maximal_pieces;
using testing::TerrainShape;

void expect_same_maps(const VisibleMap& a, const VisibleMap& b, const std::string& what) {
    ASSERT_EQ(a.rings.size(), b.rings.size()) << what;
    for (std::size_t i = 0; i < a.rings.size(); ++i) {
        const auto& one = a.rings[i];
        const auto& other = b.rings[i];
        ASSERT_EQ(one.source, other.source) << what;
        ASSERT_EQ(one.count, other.count) << what;
        for (std::size_t j = 0; j < one.count; ++j)
            EXPECT_EQ(a.vertices[a.vertices_of(one)[j]], b.vertices[b.vertices_of(other)[j]])
                << what;
    }
}

void expect_same(const ScreenScene& scene, Upward upward, const std::string& what) {
    const VisiblePieces by_terrain = terrain_pieces(scene, upward);
    const VisiblePieces by_cells = cell_raster(scene);
    const VisiblePieces by_sweep = plane_sweep(scene);
    const auto found = maximal_pieces(scene, by_terrain);
    EXPECT_TRUE(found == maximal_pieces(scene, by_cells)) << what;
    EXPECT_TRUE(found == maximal_pieces(scene, by_sweep)) << what;
    expect_same_maps(visible_map(scene, by_terrain), visible_map(scene, by_cells), what);
}

/// Any of many.
TerrainShape shape_of(std::uint64_t seed) {
    TerrainShape shape;
    shape.columns = 1 + static_cast<std::int32_t>(seed % 7);
    shape.rows = 1 + static_cast<std::int32_t>(seed / 2 % 9);
    shape.heights = 1 + static_cast<std::int32_t>(seed % 4);
    shape.flat = static_cast<std::int32_t>(seed / 4 % 2) * 6;
    shape.rise = static_cast<std::int32_t>(seed / 3 % 3);
    shape.narrowing = static_cast<std::int32_t>(seed / 8 % 3) - 1;
    shape.is_shaken = seed / 5 % 2 == 0;
    shape.sources = static_cast<testing::TerrainSources>(seed / 11 % 3);
    return shape;
}

TEST(TerrainView, SeesLikeBothEnginesWhatHasFewHeights) {
    std::size_t refused = 0;
    std::size_t pieces = 0;
    constexpr std::size_t count = 600;
    for (std::uint64_t seed = 0; seed < count && !HasFailure(); ++seed) {
        const std::string what = "seed " + std::to_string(seed);
        const ScreenScene scene = testing::terrain(seed, shape_of(seed));
        try {
            pieces += terrain_pieces(scene, Upward::with_y).pieces.size();
        } catch (const InputError&) {
            ++refused; // the shaken, and those that grow wider
            continue;
        }
        expect_same(scene, Upward::with_y, what);
        expect_same(testing::turned_over(scene), Upward::against_y, what);
    }
    EXPECT_LT(refused, count / 3);
    EXPECT_GT(pieces, 20 * count);
}

TEST(TerrainView, SeesLikeBothEnginesWhatCrossesALotBehindOneAnother) {
    for (std::uint64_t seed = 0; seed < 8 && !HasFailure(); ++seed) {
        const std::string what = "seed " + std::to_string(seed);
        const auto side = static_cast<std::int32_t>(4 + 3 * seed);
        const ScreenScene scene = testing::steep_terrain(seed, side);
        expect_same(scene, Upward::with_y, what);
        const ScreenScene hidden = testing::behind_a_slope(scene);
        expect_same(hidden, Upward::with_y, what);
        EXPECT_EQ(terrain_pieces(hidden, Upward::with_y).pieces.size(), 4U) << what;
    }
}

/// Hills of few heights on a square about the origin, in space.
Facets hills(std::uint64_t seed, std::uint32_t side) {
    Facets facets;
    for (std::uint32_t i = 0; i <= side; ++i)
        for (std::uint32_t j = 0; j <= side; ++j) {
            const bool is_border = i == 0 || j == 0 || i == side || j == side;
            facets.corners.push_back(
                {8.0 * i / side - 4,
                 8.0 * j / side - 4,
                 is_border ? 0.0 : 0.3 * static_cast<double>(random(seed, i, j) % 4)});
        }
    const auto corner = [&](std::uint32_t i, std::uint32_t j) { return i * (side + 1) + j; };
    for (std::uint32_t i = 0; i < side; ++i)
        for (std::uint32_t j = 0; j < side; ++j) {
            Facets::Triangle one;
            one.corners = {corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)};
            one.primitive = facets.triangles.size();
            facets.triangles.push_back(one);
            Facets::Triangle other;
            other.corners = {corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)};
            other.primitive = facets.triangles.size();
            facets.triangles.push_back(other);
        }
    return facets;
}

/// Whose picture stands upright: from outside, from above the hills, and by parallel rays.
Camera upright_camera(int number) {
    const double turn = 0.7 * number + 0.2;
    const Vec3 to = {std::cos(turn), std::sin(turn), 0};
    const Vec3 across = cross(to, {0, 0, 1});
    const Vec3 up = {0, 0, 1};
    Camera camera;
    camera.projection =
        number % 3 == 2 ? Camera::Projection::parallel : Camera::Projection::perspective;
    const double distance = number % 3 == 0 ? 9 : 1;
    const double half = number % 3 == 2 ? 5 : 0.6;
    camera.viewpoint = -distance * to + 2 * up;
    camera.direction = to - 0.4 * up;
    const Vec3 middle = number % 3 == 2 ? -4 * to : camera.viewpoint + 1.5 * to - 0.5 * up;
    camera.lower_left = middle - half * across - half * up;
    camera.lower_right = middle + half * across - half * up;
    camera.upper_left = middle - half * across + half * up;
    return camera;
}

TEST(TerrainView, SeesLikeBothEnginesHillsInSpace) {
    int seen = 0;
    for (int number = 0; number < 24 && !HasFailure(); ++number) {
        const auto seed = static_cast<std::uint64_t>(number);
        const Facets facets = hills(seed, static_cast<std::uint32_t>(4 + number % 5 * 3));
        std::vector<std::uint32_t> sources(facets.triangles.size());
        std::iota(sources.begin(), sources.end(), 0U);
        ScreenScene scene = screen_scene(facets, CameraMap(upright_camera(number)), sources);
        sort_by_place(scene);
        expect_same(scene, Upward::against_y, "number " + std::to_string(number));
        seen += terrain_pieces(scene).pieces.empty() ? 0 : 1;
    }
    EXPECT_GT(seen, 20);
}

ScreenScene triangles_of(const std::vector<std::array<ScreenVertex, 3>>& all) {
    ScreenScene scene;
    for (const auto& corners : all) {
        const auto first = static_cast<std::uint32_t>(scene.vertices.size());
        scene.vertices.insert(scene.vertices.end(), corners.begin(), corners.end());
        add_triangle(scene, {first, first + 1, first + 2}, 10 + first / 3);
    }
    return scene;
}

std::string message_of(const ScreenScene& scene) {
    try {
        terrain_pieces(scene, Upward::with_y);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

void expect_in(const std::string& part, const std::string& whole) {
    EXPECT_NE(whole.find(part), std::string::npos) << whole;
}

TEST(TerrainView, NamesTheFacesThatAreNoTerrain) {
    // Each lies over the next: nobody can sort them.
    const ScreenScene ring = triangles_of(
        {{{{{0, 0}, 1000}, {{900, 100}, 3000000}, {{900, 0}, 2900000}}},
         {{{{800, 0}, 1000}, {{850, 900}, 3000000}, {{900, 900}, 2900000}}},
         {{{{900, 800}, 1000}, {{0, 50}, 3000000}, {{0, 100}, 2900000}}}});
    expect_in(
        "triangle 2 (face 12) and triangle 0 (face 10) lie one above the other", message_of(ring));
    const ScreenScene wall = triangles_of({{{{{0, 0}, 70}, {{100, 0}, 70}, {{100, 90}, 70}}}});
    expect_in("triangle 0 (face 10) stands upright", message_of(wall));
    const ScreenScene apart = triangles_of(
        {{{{{0, 0}, 7000}, {{100, 0}, 7000}, {{50, 90}, 6000}}},
         {{{{0, 200}, 5000}, {{100, 200}, 5000}, {{50, 290}, 4000}}}});
    expect_in(
        "triangle 1 (face 11) leaves a gap above triangle 0 (face 10), which lies before it",
        message_of(apart));
    const ScreenScene under = triangles_of(
        {{{{{0, 200}, 7000}, {{100, 200}, 7000}, {{50, 290}, 6000}}},
         {{{{0, 0}, 5000}, {{100, 0}, 5000}, {{50, 90}, 4000}}}});
    expect_in("triangle 1 (face 11) reaches below triangle 0 (face 10)", message_of(under));
    const ScreenScene close = triangles_of(
        {{{{{0, 0}, 7}, {{100, 0}, 7}, {{50, 90}, 6}}},
         {{{{0, 0}, 6}, {{100, 0}, 6}, {{50, 90}, 5}}}});
    EXPECT_EQ(message_of(close), ""); // the first of the text is nearer
    ScreenScene turned = close;
    turned.triangles[0].source = 100;
    expect_in("so close that the grid of the picture does not tell", message_of(turned));
}

TEST(TerrainView, RefusesOrSeesLikeTheCellsWhatLiesAnyhow) {
    int refused = 0;
    int seen = 0;
    for (std::uint64_t seed = 0; seed < 3000 && !HasFailure(); ++seed) {
        ScreenScene scene = seed % 2 == 0 ? testing::layers(seed, 1 + seed % 6, 4)
                                          : testing::tangle(seed, 1 + seed % 6, 4);
        try {
            // Numbered from the nearest on, so that what is coincident is seen alike.
            std::uint32_t number = 0;
            for (const std::uint32_t i : ground_order(scene))
                scene.triangles[i].source = number++;
            const VisiblePieces found = terrain_pieces(scene, Upward::with_y);
            EXPECT_TRUE(maximal_pieces(scene, found) == maximal_pieces(scene, cell_raster(scene)))
                << "seed " << seed;
            ++seen;
        } catch (const InputError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 500);
    EXPECT_GT(seen, 100);
}

TEST(TerrainView, RefusesShadows) {
    ScreenScene scene = triangles_of({{{{{0, 0}, 7000}, {{100, 0}, 7000}, {{50, 90}, 6000}}}});
    add_triangle(scene, {0, 1, 2}, 10, 0);
    EXPECT_THROW(terrain_pieces(scene, Upward::with_y), std::invalid_argument);
}

TEST(TerrainView, SeesNothingOfNothing) {
    EXPECT_TRUE(terrain_pieces({}).pieces.empty());
}

TEST(TerrainView, EndsWhenItIsCancelledAndTellsHowFarItIs) {
    const ScreenScene scene = testing::steep_terrain(1, 40);
    double last = 0;
    terrain_pieces(scene, Upward::with_y, nullptr, [&](double done) {
        EXPECT_GE(done, 0);
        EXPECT_LE(done, 1);
        last = done;
    });
    EXPECT_GT(last, 0.5);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(terrain_pieces(scene, Upward::with_y, nullptr, {}, &cancel), Cancelled);
}

TEST(GroundOrder, PutsNoTriangleBeforeOneThatHidesIt) {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        TerrainShape shape = shape_of(seed);
        shape.narrowing = 1;
        shape.is_shaken = false;
        const ScreenScene scene = testing::terrain(seed, shape);
        const std::vector<std::uint32_t> order = ground_order(scene);
        ASSERT_EQ(order.size(), scene.triangles.size());
        const auto slopes = slopes_of(scene);
        for (std::size_t i = 0; i < order.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const std::array<std::uint32_t, 2> both = {order[j], order[i]};
                // By a point that is in both, if there is one.
                const auto corners = corners_of(scene, scene.triangles[both[0]]);
                for (const ScreenVertex& corner : corners_of(scene, scene.triangles[both[1]]))
                    if (inclusion(corners, 2 * corner.point.x, 2 * corner.point.y) > 0) {
                        EXPECT_EQ(
                            triangle_order(scene, slopes, both[0], both[1]), FrontOrder::first)
                            << "seed " << seed;
                    }
            }
    }
}

struct Steps {
    double triangles = 0;
    double crossings = 0;
    double corners = 0; ///< of what is seen
    double of_terrain = 0;
    double of_sweep = 0;
};

Steps steps_of(const ScreenScene& scene) {
    TerrainCounts counts;
    const VisiblePieces pieces = terrain_pieces(scene, Upward::with_y, &counts);
    PlaneSweepCounts swept;
    plane_sweep(scene, {std::nullopt, &swept});
    return {
        static_cast<double>(scene.triangles.size()),
        static_cast<double>(swept.crossings),
        static_cast<double>(pieces.points.size()),
        static_cast<double>(counts.steps()),
        static_cast<double>(swept.steps())};
}

/// What is crossed grows faster than the triangles, and so do the steps of a sweep; those of the
/// terrain stay within (n + v) log^2 n.
void expect_to_grow_with_what_is_seen(const std::function<ScreenScene(std::int32_t)>& family) {
    std::vector<double> triangles;
    std::vector<double> crossings;
    std::vector<double> parts;
    std::vector<double> of_terrain;
    std::vector<double> of_sweep;
    for (const std::int32_t side : {10, 14, 20, 28, 40}) {
        const Steps steps = steps_of(family(side));
        const double log_n = std::log2(steps.triangles);
        triangles.push_back(steps.triangles);
        crossings.push_back(steps.crossings);
        of_terrain.push_back(steps.of_terrain);
        of_sweep.push_back(steps.of_sweep);
        parts.push_back(steps.of_terrain / ((steps.triangles + steps.corners) * log_n * log_n));
    }
    const auto of_k = growth(triangles, crossings);
    EXPECT_GT(of_k.exponent - of_k.uncertainty, 1.35);
    const auto of_swept = growth(triangles, of_sweep);
    EXPECT_GT(of_swept.exponent - of_swept.uncertainty, 1.3);
    const auto within = growth(triangles, parts);
    EXPECT_LT(within.exponent - within.uncertainty, 0);
    // n log^2 n looks like this power between these sizes.
    const auto of_steps = growth(triangles, of_terrain);
    EXPECT_LT(of_steps.exponent, 1.25);
}

TEST(TerrainView, TakesStepsWithWhatIsSeenAndNotWithWhatCrosses) {
    expect_to_grow_with_what_is_seen(
        [](std::int32_t side) { return testing::steep_terrain(1, side); });
    expect_to_grow_with_what_is_seen(
        [](std::int32_t side) { return testing::behind_a_slope(testing::steep_terrain(1, side)); });
}

} // namespace
} // namespace vera
