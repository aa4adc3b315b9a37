// SPDX-License-Identifier: Apache-2.0
// What is seen of scenes in their shadows, made a few at a time, compared with what is seen when
// all are there.
#include "vera/visible/penetrations.h"
#include "vera/visible/shadowed_raster.h"
#include "vera/visible/shadows.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "scene/make_scene.h"
#include "visible/cameras.h"
#include "visible/drawn_shadows.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

/// A piece without the numbers that others have as well.
using Border = std::tuple<
    std::array<double, 2>,
    std::array<double, 2>,
    std::uint32_t,
    std::uint32_t,
    LightSet,
    LightSet>;

/// Of the pieces, in ascending order, each from the smaller end on. Those that go on in each other
/// are one: where an edge is touched by what is no matter there it need not be parted.
std::vector<Border> borders_of(const ScreenScene& screen, const VisiblePieces& list) {
    const auto source = [&](std::uint32_t triangle) {
        return triangle == no_triangle ? no_source : screen.triangles[triangle].source;
    };
    const auto place = [&](std::uint32_t point) {
        const RationalPoint at = list.points[point];
        return std::array{at.x(), at.y()};
    };
    const auto goes_on = [&](std::size_t i) {
        const VisiblePiece& before = list.pieces[i - 1];
        const VisiblePiece& piece = list.pieces[i];
        const UnlitBeside unlit_before = list.unlit_beside(i - 1);
        const UnlitBeside unlit = list.unlit_beside(i);
        return before.edge == piece.edge && before.to == piece.from
            && source(before.left) == source(piece.left)
            && source(before.right) == source(piece.right) && unlit_before.left == unlit.left
            && unlit_before.right == unlit.right;
    };
    std::vector<Border> borders;
    for (std::size_t i = 0, next = 0; i < list.pieces.size(); i = next) {
        for (next = i + 1; next < list.pieces.size() && goes_on(next); ++next) {
        }
        const VisiblePiece& piece = list.pieces[i];
        const std::array<double, 2> from = place(piece.from);
        const std::array<double, 2> to = place(list.pieces[next - 1].to);
        const std::uint32_t left = source(piece.left);
        const std::uint32_t right = source(piece.right);
        const UnlitBeside unlit = list.unlit_beside(i);
        borders.push_back(std::min(
            Border{from, to, left, right, unlit.left, unlit.right},
            Border{to, from, right, left, unlit.right, unlit.left}));
    }
    std::sort(borders.begin(), borders.end());
    return borders;
}

/// Whether triangles that pass through each other are cut before.
enum class Penetrating { cut, left };

/// How many shadows there were.
std::size_t expect_same_in_parts(
    const Scene& scene,
    const Camera& camera,
    const std::string& what,
    Penetrating penetrating = Penetrating::cut) {
    const CameraMap map(camera);
    const Facets all = facets(scene, [](Vec3) { return 0.05; });
    const DrawnFaces faces = drawn_faces(scene, all, FaceUnit::plane, camera);
    ScreenScene screen = screen_scene(all, map, faces.of_facet);
    sort_by_place(screen);
    const VisiblePieces before =
        penetrating == Penetrating::cut ? whole_pieces(screen).pieces : cell_raster(screen);
    const ShadowedScene shadowed = {scene, all, faces, camera, map, 512, 512, before};

    ScreenScene with_all = screen;
    const std::size_t shadows = add_shadows(shadowed, with_all).shadows;
    const std::vector<Border> expected = borders_of(with_all, cell_raster(with_all));
    const std::size_t triangles = screen.triangles.size();
    for (const std::size_t at_a_time : {std::size_t{1}, std::size_t{40}, std::size_t{16384}}) {
        ScreenScene in_parts = screen;
        const ThrownShadows thrown(shadowed, in_parts);
        const ShadowedPieces found =
            shadowed_cell_raster(in_parts, before, thrown, {}, nullptr, {}, at_a_time);
        EXPECT_EQ(found.shadows, shadows) << what;
        EXPECT_EQ(in_parts.triangles.size(), triangles) << what;
        EXPECT_TRUE(borders_of(in_parts, found.pieces) == expected)
            << what << ", " << at_a_time << " at a time";
        EXPECT_TRUE(std::ranges::is_sorted(found.pieces.pieces, {}, &VisiblePiece::edge)) << what;
    }
    return shadows;
}

TEST(ShadowedRaster, SeesInPartsWhatIsSeenWithAllShadows) {
    std::size_t shadows = 0;
    for (std::uint64_t seed = 0; seed < 8 && !HasFailure(); ++seed)
        shadows += expect_same_in_parts(
            testing::scene_of_planes(seed),
            testing::camera_number(static_cast<int>(seed)),
            "seed " + std::to_string(seed));
    EXPECT_GT(shadows, 500U);
}

TEST(ShadowedRaster, SeesTheSameWhereTrianglesPassThroughEachOther) {
    for (std::uint64_t seed = 0; seed < 8 && !HasFailure(); ++seed)
        expect_same_in_parts(
            testing::scene_of_planes(seed),
            testing::camera_number(static_cast<int>(seed)),
            "seed " + std::to_string(seed),
            Penetrating::left);
}

/// Squares of a board, and walls, floors and steps on it whose corners share a few places: shadows
/// begin where things stand on each other, and end on the borders of squares.
Scene stage(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto below = [&](std::uint64_t count) { return static_cast<double>(random() % count); };
    Scene scene;
    for (int x = 0; x < 4; ++x)
        for (int y = 0; y < 4; ++y)
            test::add_polygon(
                scene.geometry,
                {{1.0 * x, 1.0 * y, 0},
                 {x + 1.0, 1.0 * y, 0},
                 {x + 1.0, y + 1.0, 0},
                 {1.0 * x, y + 1.0, 0}});
    for (int i = 0; i < 5; ++i) {
        const double x = below(4);
        const double y = below(4);
        const double z = below(2);
        if (below(2) == 0)
            test::add_polygon(
                scene.geometry, {{x, y, z}, {x + 1, y, z}, {x + 1, y, z + 1}, {x, y, z + 1}});
        else
            test::add_polygon(
                scene.geometry,
                {{x, y, z + 1}, {x + 1, y, z + 1}, {x + 1, y + 1, z + 1}, {x, y + 1, z + 1}});
    }
    scene.lights = {{.position = {6, -3, 4}}, {.position = {1.5, 1.5, 3.5}}};
    number_primitives(scene);
    return scene;
}

TEST(ShadowedRaster, SeesTheSameWhereThingsStandOnEachOther) {
    Camera camera;
    camera.viewpoint = {2, -5, 6};
    camera.lower_left = {-1.5, -2, 0};
    camera.lower_right = {5.5, -2, 0};
    camera.upper_left = {-1.5, 2, 5};
    std::size_t shadows = 0;
    for (std::uint64_t seed = 0; seed < 24 && !HasFailure(); ++seed)
        shadows += expect_same_in_parts(stage(seed), camera, "seed " + std::to_string(seed));
    EXPECT_GT(shadows, 500U);
}

/// Strips that cross each other, each seen in many parts, below small triangles all over them.
Scene strips_below_leaves() {
    std::mt19937_64 random(11);
    const auto between = [&](double least, double most) {
        return least + (most - least) * static_cast<double>(random() % 1024) / 1024;
    };
    Scene scene;
    for (int i = 0; i < 48; ++i) {
        const double at = between(-1, 1);
        const double z = 0.01 * i;
        if (i % 2 == 0)
            test::add_polygon(
                scene.geometry, {{at, -1, z}, {at + 0.03, -1, z}, {at + 0.03, 1, z}, {at, 1, z}});
        else
            test::add_polygon(
                scene.geometry, {{-1, at, z}, {1, at, z}, {1, at + 0.03, z}, {-1, at + 0.03, z}});
    }
    for (int i = 0; i < 400; ++i) {
        const double x = between(-1, 1);
        const double y = between(-1, 1);
        const double z = between(0.6, 0.8);
        test::add_polygon(scene.geometry, {{x, y, z}, {x + 0.02, y, z}, {x, y + 0.02, z + 0.01}});
    }
    scene.lights = {{.position = {2, 1, 4}}};
    number_primitives(scene);
    return scene;
}

TEST(ShadowedRaster, MakesShadowsAFewTimesWhereFacesAreSeenBetweenEachOther) {
    const Scene scene = strips_below_leaves();
    Camera camera;
    camera.viewpoint = {0, 0, 6};
    camera.lower_left = {-1, -1, 0};
    camera.lower_right = {1, -1, 0};
    camera.upper_left = {-1, 1, 0};
    const CameraMap map(camera);
    const Facets all = facets(scene, [](Vec3) { return 0.05; });
    const DrawnFaces faces = drawn_faces(scene, all, FaceUnit::plane, camera);
    ScreenScene screen = screen_scene(all, map, faces.of_facet);
    sort_by_place(screen);
    const WholePieces whole = whole_pieces(screen);
    const ShadowedScene shadowed = {scene, all, faces, camera, map, 512, 512, whole.pieces};
    const ThrownShadows thrown(shadowed, screen);
    const auto made = [&](std::size_t at_a_time) {
        ScreenScene in_parts = screen;
        return shadowed_cell_raster(in_parts, whole.pieces, thrown, {}, nullptr, {}, at_a_time)
            .made;
    };
    EXPECT_GT(thrown.count(), 1000U);
    EXPECT_LE(made(~std::size_t{0}), thrown.count());
    EXPECT_LE(made(1), 8 * thrown.count());
}

} // namespace
} // namespace vera
