// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include "reference/reference_renderer.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera::reference {
namespace {

/// Seen from (0, 0, 10) towards the origin, through the square from -2 to 2 at z = 0.
Scene empty_scene() {
    Scene scene;
    scene.camera = Camera{
        .projection = Camera::Projection::perspective,
        .viewpoint = {0, 0, 10},
        .direction = {},
        .lower_left = {-2, -2, 0},
        .lower_right = {2, -2, 0},
        .upper_left = {-2, 2, 0}};
    scene.materials.resize(1);
    return scene;
}

void add_sphere(Geometry& geometry, Sphere sphere) {
    geometry.items.push_back(
        {.kind = ItemKind::sphere,
         .index = static_cast<std::uint32_t>(geometry.spheres.size()),
         .material = MaterialId{0}});
    geometry.spheres.push_back(sphere);
}

void add_triangle(Geometry& geometry, Triangle triangle) {
    geometry.items.push_back(
        {.kind = ItemKind::triangle,
         .index = static_cast<std::uint32_t>(geometry.triangles.size()),
         .material = MaterialId{0}});
    geometry.triangles.push_back(triangle);
}

void add_shape(Geometry& geometry, RotationalShape shape) {
    geometry.items.push_back(
        {.kind = ItemKind::rotational_shape,
         .index = static_cast<std::uint32_t>(geometry.rotational_shapes.size()),
         .material = MaterialId{0}});
    geometry.rotational_shapes.push_back(std::move(shape));
}

PictureSettings settings_of(std::uint32_t side, std::uint32_t depth) {
    PictureSettings settings;
    settings.width = side;
    settings.height = side;
    settings.depth = depth;
    return settings;
}

TEST(Reference, LightsAWallByTheFormula) {
    Scene scene = empty_scene();
    scene.materials[0].drf = {0.5, 0.25, 1};
    add_triangle(scene.geometry, {{Vec3{-9, -9, 0}, Vec3{9, -9, 0}, Vec3{0, 9, 0}}});
    scene.lights.push_back({.position = {3, 0, 4}, .intensity = 25, .color = {1, 1, 0.5}});
    PictureSettings settings = settings_of(1, 1);
    settings.ambient = {0.2, 0.2, 0.2};
    // L.N = 4/5, d^2 = 25, R.N = 1: (0.8 + 0.2) 0.5, (0.8 + 0.2) 0.25, 0.4 + 0.2.
    EXPECT_THAT(reference_picture(scene, settings).bytes, testing::ElementsAre(128, 64, 153));
}

TEST(Reference, FindsTheHighlightInTheMirrorDirection) {
    Scene scene = empty_scene();
    scene.materials[0].spc = 0.5;
    add_triangle(scene.geometry, {{Vec3{-9, -9, 0}, Vec3{9, -9, 0}, Vec3{0, 9, 0}}});
    scene.lights.push_back({.position = {0, 0, 2}, .intensity = 2, .color = {1, 1, 1}});
    // f(1) = 1, 2 / 2^2 = 1/2.
    EXPECT_THAT(
        reference_picture(scene, settings_of(1, 1)).bytes, testing::ElementsAre(128, 128, 128));
    scene.lights[0].position = {4, 0, 3};
    // L.S = 3/5: f = 0.1 * -0.9 / 0.25 = -0.36, squared 0.1296, times 2 / 25.
    scene.lights[0].intensity = 200;
    EXPECT_EQ(reference_picture(scene, settings_of(1, 1)).bytes[0], 255);
    scene.lights[0].intensity = 25;
    EXPECT_EQ(reference_picture(scene, settings_of(1, 1)).bytes[0], 33);
}

TEST(Reference, FiltersTheSkyTwiceThroughABallOfTheAirsIndex) {
    Scene scene = empty_scene();
    scene.materials[0].tab = {0.5, 0.8, 1};
    add_sphere(scene.geometry, {{0, 0, 0}, 1});
    PictureSettings settings = settings_of(1, 3);
    settings.firmament = Firmament{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
    EXPECT_THAT(reference_picture(scene, settings).bytes, testing::ElementsAre(64, 163, 255));
    settings.depth = 2;
    EXPECT_THAT(reference_picture(scene, settings).bytes, testing::ElementsAre(0, 0, 0));
}

TEST(Reference, MirrorsTotallyWhereGlassIsLeftTooFlat) {
    // From within glass (REF 2 on this side) at 45 degrees nothing gets out: sin 45 * 2 > 1.
    Scene scene = empty_scene();
    scene.camera->viewpoint = {0, 10, 10};
    scene.materials[0].tab = {1, 1, 1};
    scene.materials[0].ref = 2;
    add_triangle(scene.geometry, {{Vec3{-90, -90, 0}, Vec3{0, 90, 0}, Vec3{90, -90, 0}}});
    // A lamp where the mirrored ray goes.
    scene.materials.push_back({});
    scene.materials[1].sdi = {1, 1, 1};
    add_sphere(scene.geometry, {{0, -10, 10}, 3});
    scene.geometry.items.back().material = MaterialId{1};
    EXPECT_EQ(reference_picture(scene, settings_of(1, 2)).bytes[0], 255);
    // The other way round the ray is bent towards the normal and goes on.
    scene.materials[0].ref = 0.5;
    EXPECT_EQ(reference_picture(scene, settings_of(1, 2)).bytes[0], 0);
}

TEST(Reference, ShadowsAWallByTheProductOfTheFilters) {
    Scene scene = empty_scene();
    scene.materials[0].drf = {1, 1, 1};
    scene.materials.push_back({});
    scene.materials[1].tab = {0.5, 0.25, 0};
    add_triangle(scene.geometry, {{Vec3{-9, -9, 0}, Vec3{9, -9, 0}, Vec3{0, 9, 0}}});
    add_sphere(scene.geometry, {{3, 0, 4}, 1});
    scene.geometry.items.back().material = MaterialId{1};
    scene.lights.push_back({.position = {6, 0, 8}, .intensity = 125, .color = {1, 1, 1}});
    // L.N = 4/5, 125 / 100, through two walls.
    EXPECT_THAT(reference_picture(scene, settings_of(1, 1)).bytes, testing::ElementsAre(64, 16, 0));
}

TEST(Reference, ShowsABallOfConicArcsLikeASphere) {
    Scene sphere = empty_scene();
    sphere.materials[0].drf = {0.5, 0.5, 0.5};
    sphere.materials[0].rab = {0.3, 0.3, 0.3};
    sphere.materials[0].tab = {0.4, 0.5, 0.6};
    sphere.materials[0].ref = 1.5;
    sphere.lights.push_back({.position = {5, 8, 9}, .intensity = 100, .color = {1, 1, 1}});
    Scene shape = sphere;
    add_sphere(sphere.geometry, {{0, 0, 0}, 1.5});
    const double weight = std::sqrt(0.5);
    const auto arc = [&](double r, double h, double end_r, double end_h) {
        ContourPiece piece;
        piece.kind = ContourPiece::Kind::conic;
        piece.control[0] = {r, h};
        piece.weight = weight;
        piece.end = {end_r, end_h};
        return piece;
    };
    add_shape(
        shape.geometry,
        {.base = {0, 0, 0},
         .axis = {0.6, 0, 0.8},
         .start = {0, -1.5},
         .contour = {arc(1.5, -1.5, 1.5, 0), arc(1.5, 1.5, 0, 1.5)}});
    PictureSettings settings = settings_of(24, 5);
    settings.firmament = Firmament{{0.2, 0.4, 1}, {1, 1, 1}, {0.4, 0.3, 0.2}};
    EXPECT_EQ(reference_picture(sphere, settings).bytes, reference_picture(shape, settings).bytes);
}

TEST(Reference, ShowsAStraightCubicLikeACone) {
    Scene straight = empty_scene();
    straight.materials[0].drf = {0.8, 0.8, 0.8};
    straight.lights.push_back({.position = {5, 8, 9}, .intensity = 100, .color = {1, 1, 1}});
    Scene curved = straight;
    ContourPiece piece;
    piece.end = {0, 1.5};
    const Vec3 axis = {0, 0.8, 0.6};
    add_shape(
        straight.geometry, {.base = {}, .axis = axis, .start = {1.5, -1}, .contour = {piece}});
    piece.kind = ContourPiece::Kind::cubic;
    piece.control = {ContourPiece::Point{0.9, 0}, ContourPiece::Point{0.3, 1}};
    add_shape(curved.geometry, {.base = {}, .axis = axis, .start = {1.5, -1}, .contour = {piece}});
    const PictureSettings settings = settings_of(24, 2);
    EXPECT_EQ(
        reference_picture(straight, settings).bytes, reference_picture(curved, settings).bytes);
}

TEST(Reference, CarriesASubsceneIntoPlaceMirroringsIncluded) {
    // The same two triangles, one written in place and one called as a mirror image; the mirrored
    // one's normal is (p2-p1) x (p3-p1) in its own coordinates, carried over.
    Scene in_place = empty_scene();
    in_place.materials[0].tab = {1, 1, 1};
    in_place.materials[0].ref = 2;
    Scene called = in_place;
    add_triangle(in_place.geometry, {{Vec3{2, -9, 0}, Vec3{-9, 9, 0}, Vec3{-9, -9, 1}}});
    called.subscenes.resize(1);
    add_triangle(called.subscenes[0], {{Vec3{-2, -9, 0}, Vec3{9, -9, 1}, Vec3{9, 9, 0}}});
    const Affine3 mirroring = {{{Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}}, {}};
    called.geometry.items.push_back({.kind = ItemKind::subscene_call});
    called.geometry.calls.push_back({SubsceneId{0}, mirroring, mirroring});
    PictureSettings settings = settings_of(8, 2);
    settings.firmament = Firmament{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}};
    const auto expected = reference_picture(in_place, settings).bytes;
    // Mirrored corners in the same order have the opposite normal from what the order says there:
    // (2, 3) exchanged makes up for it in place.
    EXPECT_EQ(reference_picture(called, settings).bytes, expected);
}

TEST(Reference, ScalesTheLightToTheMeasuredExposure) {
    Scene scene = empty_scene();
    scene.materials[0].drf = {1, 0.5, 0.5};
    scene.materials[0].sdi = {0.25, 0, 0};
    add_triangle(scene.geometry, {{Vec3{-9, -9, 0}, Vec3{9, -9, 0}, Vec3{0, 9, 0}}});
    PictureSettings settings = settings_of(1, 1);
    // A parallel view, so that R.N is 1 everywhere: the value is 0.125 s + 0.25.
    scene.camera->projection = Camera::Projection::parallel;
    scene.camera->direction = {0, 0, -3};
    settings.ambient = {0.125, 0.125, 0.125};
    settings.exposure = 0.75;
    const ReferencePicture picture = reference_picture(scene, settings);
    EXPECT_NEAR(picture.light_factor, 4, 1e-12);
    EXPECT_THAT(picture.bytes, testing::ElementsAre(191, 64, 64));
    settings.exposure = 0.2;
    EXPECT_EQ(reference_picture(scene, settings).light_factor, 1);
}

TEST(Reference, PutsTheEarlierOfTwoCoincidingFacesInFront) {
    Scene scene = empty_scene();
    scene.materials[0].sdi = {1, 0, 0};
    scene.materials.push_back({});
    scene.materials[1].sdi = {0, 1, 0};
    add_triangle(scene.geometry, {{Vec3{-9, -9, 0.1}, Vec3{9, -9, 0.1}, Vec3{0, 9, 0.3}}});
    add_triangle(scene.geometry, {{Vec3{0, 9, 0.3}, Vec3{9, -9, 0.1}, Vec3{-9, -9, 0.1}}});
    scene.geometry.items[1].material = MaterialId{1};
    EXPECT_THAT(reference_picture(scene, settings_of(1, 1)).bytes, testing::ElementsAre(255, 0, 0));
    std::swap(scene.geometry.items[0], scene.geometry.items[1]);
    EXPECT_THAT(reference_picture(scene, settings_of(1, 1)).bytes, testing::ElementsAre(0, 255, 0));
}

} // namespace
} // namespace vera::reference
