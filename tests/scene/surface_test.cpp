// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/bounds.h"
#include "vera/scene/surface.h"

#include <cmath>
#include <limits>

#include "scene/make_scene.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using test::add;

void expect_near(Vec3 a, Vec3 b, double tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

SubsceneCall call_of(std::uint32_t subscene, const Affine3& map) {
    return {SubsceneId{subscene}, map, *inverse(map)};
}

TEST(SurfaceAt, TurnsNormalsToTheOutside) {
    for (const auto& [outside, z] :
         {std::pair{Outside::by_normal, 1.0},
          std::pair{Outside::along_normal, 1.0},
          std::pair{Outside::against_normal, -1.0}}) {
        Scene scene;
        add(scene.geometry, Triangle{{Vec3{0, 0, 1}, Vec3{1, 0, 1}, Vec3{0, 1, 1}}});
        scene.geometry.items[0].outside = outside;
        number_primitives(scene);
        const SurfacePoint at = surface_at(scene, {{0.25, 0.25, 0}, {0, 0, 1}}, {1, {0, 0}});
        EXPECT_EQ(at.geometric_normal, (Vec3{0, 0, z}));
        EXPECT_EQ(at.shading_normal, (Vec3{0, 0, z}));
        EXPECT_EQ(at.point, (Vec3{0.25, 0.25, 1}));
    }
}

TEST(SurfaceAt, InterpolatesThePatchNormals) {
    Scene scene;
    Patch patch;
    patch.corners = {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
    patch.normals = {Vec3{0, 0, -1}, Vec3{1, 0, -1}, Vec3{0, 1, -1}};
    add(scene.geometry, patch);
    patch.normals = {Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{0, 0, 0}};
    add(scene.geometry, patch);
    number_primitives(scene);
    const SurfacePoint at = surface_at(scene, {{0.25, 0.5, -2}, {0, 0, 1}}, {2, {0, 0}});
    expect_near(at.shading_normal, normalized({0.25, 0.5, -1}), 1e-15);
    EXPECT_EQ(at.geometric_normal, (Vec3{0, 0, -1})) << "the side of the interpolated normal";
    // Normals that cancel leave the face's own.
    const SurfacePoint none = surface_at(scene, {{0.25, 0.5, -2}, {0, 0, 1}}, {2, {1, 0}});
    EXPECT_EQ(none.shading_normal, (Vec3{0, 0, 1}));
    EXPECT_EQ(none.geometric_normal, (Vec3{0, 0, 1}));
}

TEST(SurfaceAt, GivesRotationalShapesTheOuterSideOfTheirContour) {
    Scene scene;
    RotationalShape shape;
    for (const ContourPiece::Point end :
         {ContourPiece::Point{1, 0}, ContourPiece::Point{1, 50}, ContourPiece::Point{0, 50}}) {
        ContourPiece piece;
        piece.end = end;
        shape.contour.push_back(piece);
    }
    add(scene.geometry, shape);
    number_primitives(scene);
    EXPECT_EQ(
        surface_at(scene, {{0.5, 0, -5}, {0, 0, 1}}, {5, {0, 0}}).geometric_normal,
        (Vec3{0, 0, -1}));
    EXPECT_EQ(
        surface_at(scene, {{-5, 0, 25}, {1, 0, 0}}, {4, {0, 1}}).geometric_normal,
        (Vec3{-1, 0, 0}));
    EXPECT_EQ(
        surface_at(scene, {{0, 0, 60}, {0, 0, -1}}, {10, {0, 2}}).geometric_normal,
        (Vec3{0, 0, 1}));
}

TEST(SurfaceAt, CarriesNormalsByTheInverseTranspose) {
    Scene scene;
    scene.materials.resize(3);
    scene.subscenes.resize(1);
    add(scene.subscenes[0], Sphere{{0, 0, 0}, 1});
    Affine3 map = scaling(1);
    map.linear.rows[0].x = -4; // a mirrored ellipsoid
    map.translation = {10, 0, 0};
    add(scene.geometry, Sphere{{0, 0, 0}, 1});
    add(scene.geometry, call_of(0, map));
    add(scene.geometry, call_of(0, map));
    scene.geometry.items[1].material = MaterialId{2};
    number_primitives(scene);

    const double h = std::sqrt(0.5);
    const Ray ray = {{10 - 4 * h, h, -3}, {0, 0, 1}};
    const SurfacePoint at = surface_at(scene, ray, {3, {1, 0}});
    expect_near(at.point, {10 - 4 * h, h, 0}, 1e-15 + at.point_error);
    expect_near(at.geometric_normal, normalized({-h / 4, h, 0}), 1e-14);
    EXPECT_EQ(at.material, MaterialId{2});
    EXPECT_EQ(surface_at(scene, ray, {3, {2, 0}}).material, inherited_material);
}

TEST(PathTo, LeadsThroughTenThousandCalls) {
    Scene scene;
    constexpr std::uint32_t levels = 10000;
    scene.subscenes.resize(levels);
    add(scene.subscenes[0], Sphere{{0, 0, 0}, 1});
    add(scene.subscenes[0], Sphere{{0, 0, 5}, 1});
    for (std::uint32_t level = 0; level < levels; ++level) {
        Geometry& geometry = level + 1 == levels ? scene.geometry : scene.subscenes[level + 1];
        add(geometry, Mesh{});
        add(geometry, call_of(level, translation({1, 0, 0})));
        add(geometry, Sphere{{0, -9, 0}, 1});
    }
    number_primitives(scene);
    EXPECT_EQ(scene.geometry.primitive_count, levels + 2);
    const PrimitivePath path = path_to(scene, 1);
    EXPECT_EQ(path.element.item, 1U);
    EXPECT_EQ(path.geometry, &scene.subscenes[0]);
    EXPECT_EQ(path.to_world.translation, (Vec3{levels, 0, 0}));
    EXPECT_EQ(path.from_world.translation, (Vec3{-double{levels}, 0, 0}));
    EXPECT_EQ(path_to(scene, levels + 1).element.item, 2U);
    EXPECT_TRUE(path_to(scene, levels + 1).in_main_scene);
    EXPECT_EQ(path_to(scene, 2).geometry, &scene.subscenes[1]);
    expect_near(bounds(scene).upper, {levels + 1, 1, 6}, 1e-6);
}

TEST(PathTo, NamesThePrimitiveThatIsNumberedSo) {
    Scene scene;
    scene.subscenes.resize(2);
    for (int i = 0; i < 2; ++i) {
        Mesh mesh;
        mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        for (int k = 0; k < 3 * (i + 2); ++k)
            mesh.position_indices.push_back(static_cast<std::uint32_t>(k % 3));
        add(scene.subscenes[1], mesh);
        add(scene.subscenes[1], Sphere{});
    }
    add(scene.geometry, Sphere{});
    add(scene.geometry, call_of(0, {})); // empty
    add(scene.geometry, call_of(1, {}));
    add(scene.geometry, Mesh{});
    add(scene.geometry, Sphere{});
    add(scene.geometry, call_of(1, {}));
    number_primitives(scene);
    for (std::uint64_t i = 0; i < scene.geometry.primitive_count; ++i) {
        const PrimitivePath path = path_to(scene, i);
        const std::uint64_t inner = primitive_number(*path.geometry, path.element);
        if (path.in_main_scene)
            EXPECT_EQ(inner, i);
        else
            EXPECT_EQ(inner, (i - 1) % 8) << i;
    }
}

TEST(Bounds, OfCurvesAreTightAndHoldThem) {
    RotationalShape shape;
    shape.base = {1, 2, 3};
    shape.axis = normalized({1, 2, 2});
    shape.start = {0, 0};
    ContourPiece curve;
    curve.kind = ContourPiece::Kind::cubic;
    curve.control = {ContourPiece::Point{3, -1}, ContourPiece::Point{2, 4}};
    curve.end = {0, 2};
    shape.contour = {curve};
    const Box3 box = bounds(shape);

    const Vec3 u = normalized(cross(shape.axis, {0, 0, 1}));
    const Vec3 v = cross(shape.axis, u);
    Box3 sampled;
    for (int i = 0; i <= 1000; ++i)
        for (int j = 0; j < 360; ++j) {
            const double p = i / 1000.0;
            const double q = 1 - p;
            const double r = 3 * q * q * p * 3 + 3 * q * p * p * 2;
            const double h = 3 * q * q * p * -1 + 3 * q * p * p * 4 + p * p * p * 2;
            const double angle = j / 57.29577951308232;
            sampled = grown(
                sampled,
                shape.base + h * shape.axis + r * std::cos(angle) * u + r * std::sin(angle) * v);
        }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_LE(box.lower[axis], sampled.lower[axis] + 1e-14);
        EXPECT_GE(box.upper[axis], sampled.upper[axis] - 1e-14);
        EXPECT_NEAR(box.lower[axis], sampled.lower[axis], 2e-4);
        EXPECT_NEAR(box.upper[axis], sampled.upper[axis], 2e-4);
    }
}

} // namespace
} // namespace vera
