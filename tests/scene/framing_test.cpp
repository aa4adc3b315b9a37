// SPDX-License-Identifier: Apache-2.0
#include "vera/base/diagnostic.h"
#include "vera/scene/framing.h"
#include "vera/scene/inspection.h"
#include "vera/scene/support.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "scene/make_scene.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using test::add;

/// Points all over the scene's surfaces, close together.
std::vector<Vec3> sampled(const Scene& scene) {
    std::vector<Vec3> points;
    constexpr int steps = 500;
    for (const Sphere& sphere : scene.geometry.spheres)
        for (int i = 0; i < steps; ++i)
            for (int j = 0; j < steps; ++j) {
                const double z = 2.0 * i / (steps - 1) - 1;
                const double angle = 2 * std::numbers::pi * j / steps;
                const double r = std::sqrt(1 - z * z);
                points.push_back(
                    sphere.center
                    + sphere.radius * Vec3{r * std::cos(angle), r * std::sin(angle), z});
            }
    for (const Triangle& triangle : scene.geometry.triangles)
        points.insert(points.end(), triangle.corners.begin(), triangle.corners.end());
    return points;
}

struct Window {
    double left = std::numeric_limits<double>::infinity();
    double right = -left;
    double bottom = left;
    double top = -left;
};

/// The part of the picture that the points take, from 0 to 1 across and upwards.
Window seen(const Camera& camera, const std::vector<Vec3>& points) {
    Window window;
    const Vec3 u = camera.lower_right - camera.lower_left;
    const Vec3 v = camera.upper_left - camera.lower_left;
    const Vec3 normal = cross(u, v);
    for (const Vec3& point : points) {
        const bool parallel = camera.projection == Camera::Projection::parallel;
        const Vec3 direction = parallel ? camera.direction : point - camera.viewpoint;
        const Vec3 from = parallel ? point : camera.viewpoint;
        const double t = dot(normal, camera.lower_left - from) / dot(normal, direction);
        const Vec3 image = from + t * direction - camera.lower_left;
        const double x = dot(cross(v, normal), image) / dot(cross(v, normal), u);
        const double y = dot(cross(normal, u), image) / dot(cross(normal, u), v);
        window.left = std::min(window.left, x);
        window.right = std::max(window.right, x);
        window.bottom = std::min(window.bottom, y);
        window.top = std::max(window.top, y);
    }
    return window;
}

void expect_framed(const Window& window, double margin, double tolerance) {
    const double across = window.right - window.left;
    const double upwards = window.top - window.bottom;
    EXPECT_NEAR(std::max(across, upwards), 1 - 2 * margin, tolerance);
    EXPECT_NEAR(window.left, 1 - window.right, tolerance);
    EXPECT_NEAR(window.bottom, 1 - window.top, tolerance);
}

Scene tetrahedron() {
    Scene scene;
    const Vec3 a = {3, 1, -20};
    const Vec3 b = {9, 2, -23};
    const Vec3 c = {4, 8, -21};
    const Vec3 d = {5, 2, -30};
    for (const Triangle& triangle :
         {Triangle{{a, b, c}}, Triangle{{a, b, d}}, Triangle{{b, c, d}}, Triangle{{a, c, d}}})
        add(scene.geometry, triangle);
    number_primitives(scene);
    return scene;
}

Camera front_camera() {
    Camera camera;
    camera.viewpoint = {1, 2, 10};
    camera.lower_left = {-2, -1, 5};
    camera.lower_right = {3, -1, 4};
    camera.upper_left = {-2, 3, 5.5};
    return camera;
}

TEST(Framing, TouchesTheMarginExactlyWithCorners) {
    const Scene scene = tetrahedron();
    const auto points = sampled(scene);
    for (const std::uint32_t width : {512U, 1000U, 100U})
        for (const double margin : {0.0, 0.05, 0.25}) {
            const FrameSettings frame = {width, 512, margin, 1.25};
            expect_framed(seen(framed_camera(scene, frame), points), margin, 1e-9);
            expect_framed(
                seen(reframed_camera(scene, front_camera(), frame), points), margin, 1e-9);
            Camera parallel = front_camera();
            parallel.projection = Camera::Projection::parallel;
            parallel.direction = {0.25, -0.125, -2};
            expect_framed(seen(reframed_camera(scene, parallel, frame), points), margin, 1e-9);
        }
}

TEST(Framing, TouchesTheMarginWithRoundSilhouettes) {
    Scene scene;
    add(scene.geometry, Sphere{{0, 1, 0}, 2});
    add(scene.geometry, Sphere{{4, 1, -3}, 0.5});
    number_primitives(scene);
    const auto points = sampled(scene);
    const FrameSettings frame = {640, 480, 0.05, 1};
    // The samples lie up to 1e-4 of the size inside of the silhouette.
    expect_framed(seen(framed_camera(scene, frame), points), 0.05, 1e-4);
    expect_framed(seen(reframed_camera(scene, front_camera(), frame), points), 0.05, 1e-4);
}

TEST(Framing, GivesPixelsTheirShape) {
    const FrameSettings frame = {640, 480, 0.05, 1.5};
    for (const Camera& camera :
         {framed_camera(tetrahedron(), frame),
          reframed_camera(tetrahedron(), front_camera(), frame)}) {
        const double pixel_width = length(camera.lower_right - camera.lower_left) / 640;
        const double pixel_height = length(camera.upper_left - camera.lower_left) / 480;
        EXPECT_NEAR(pixel_width / pixel_height, 1.5, 1e-9);
    }
}

TEST(Framing, SeesThroughSubscenesWithoutExpandingThem) {
    // 2^60 spheres: each level calls the one before it twice.
    Scene scene;
    constexpr std::uint32_t levels = 60;
    scene.subscenes.resize(levels + 1);
    add(scene.subscenes[0], Sphere{{0, 0, 0}, 1});
    for (std::uint32_t level = 0; level <= levels; ++level) {
        Geometry& geometry = level == levels ? scene.geometry : scene.subscenes[level + 1];
        for (const double side : {-1.0, 1.0}) {
            const Affine3 map = composed(translation({side * 0.25, side * 0.125, 0}), scaling(0.5));
            add(geometry, SubsceneCall{SubsceneId{level}, map, *inverse(map)});
        }
    }
    const SceneSupport support(scene);
    const double reach = support.farthest_point({1, 0, 0})->x;
    EXPECT_NEAR(reach, 0.5, 1e-12);
}

TEST(Framing, RefusesWhatCannotBeFramed) {
    Scene scene;
    number_primitives(scene);
    EXPECT_THROW(framed_camera(scene, {}), InputError);
    EXPECT_THROW(reframed_camera(scene, front_camera(), {}), InputError);
    add(scene.geometry, Sphere{{1, 2, 10}, 2});
    number_primitives(scene);
    EXPECT_THROW(reframed_camera(scene, front_camera(), {}), InputError);
    EXPECT_NO_THROW(framed_camera(scene, {}));
}

std::vector<Finding::Kind> kinds(const Scene& scene) {
    std::vector<Finding::Kind> result;
    for (const Finding& finding : inspect(scene, scene.defaults))
        result.push_back(finding.kind);
    return result;
}

TEST(Inspection, FindsWhatMakesAPictureBlack) {
    Scene scene = tetrahedron();
    scene.camera = front_camera();
    EXPECT_EQ(kinds(scene), std::vector{Finding::Kind::no_light});
    scene.lights.push_back({});
    EXPECT_TRUE(kinds(scene).empty());

    scene.materials.push_back({"grey", {}, {}, {}, {}, {}, {}, 1, 1});
    EXPECT_EQ(used_materials(scene), std::vector{false});
    scene.geometry.items[0].material = MaterialId{0};
    EXPECT_EQ(used_materials(scene), std::vector{true});
    EXPECT_TRUE(kinds(scene).empty());

    scene.camera->viewpoint = {5, 3, -40};
    EXPECT_TRUE(kinds(scene).empty());
    std::swap(scene.camera->lower_left.z, scene.camera->viewpoint.z);
    scene.camera->lower_right.z = scene.camera->upper_left.z = -40;
    scene.camera->viewpoint.z = -35;
    EXPECT_EQ(kinds(scene), std::vector{Finding::Kind::all_behind_viewer});
}

TEST(Inspection, FindsWhatTheViewPointLiesIn) {
    Scene scene;
    scene.camera = front_camera();
    scene.lights.push_back({});
    scene.files = {"ball.vera"};
    scene.subscenes.resize(1);
    add(scene.subscenes[0], Sphere{{0, 0, 0}, 1});
    scene.subscenes[0].items[0].line = 7;
    const Affine3 map = composed(translation({1, 2, 9}), scaling(3));
    add(scene.geometry, SubsceneCall{SubsceneId{0}, map, *inverse(map)});
    number_primitives(scene);
    const auto findings = inspect(scene, scene.defaults);
    ASSERT_EQ(findings.size(), 1U);
    EXPECT_EQ(findings[0].kind, Finding::Kind::viewpoint_in_object);
    EXPECT_EQ(findings[0].problem, "the view point lies inside this sphere");
    ASSERT_TRUE(findings[0].item);
    EXPECT_EQ(findings[0].item->line, 7U);
}

} // namespace
} // namespace vera
