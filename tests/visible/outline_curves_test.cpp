// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/elliptic_arc.h"
#include "vera/math/transform.h"
#include "vera/visible/outline_curves.h"

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

/// Looks at the origin along one of few directions.
Camera camera_number(std::uint64_t number) {
    const Vec3 to = normalized(
        std::array<Vec3, 4>{{{1, 0.3, 0.2}, {0, 0, 1}, {-0.2, 1, 0.4}, {-1, 0, 0}}}[number % 4]);
    const Vec3 across = normalized(cross(to, {0.1, 0.2, 1}));
    const Vec3 up = cross(across, to);
    Camera camera;
    camera.projection =
        number / 4 % 2 == 0 ? Camera::Projection::perspective : Camera::Projection::parallel;
    camera.viewpoint = -8 * to;
    camera.direction = to;
    camera.lower_left = -3 * across - 2 * up;
    camera.lower_right = 3 * across - 2 * up;
    camera.upper_left = -3 * across + 2 * up;
    return camera;
}

PictureSettings picture_of_600_by_500() {
    PictureSettings picture; // pixels that are not square
    picture.width = 600;
    picture.height = 500;
    return picture;
}

Ray ray_through(const Camera& camera, DrawingPoint point) {
    return view_ray(camera, point.x / 600, point.y / 500);
}

TEST(OutlineEllipse, OfABallIsWhereRaysTouchIt) {
    std::mt19937_64 random(1);
    const double values[] = {-2, -1, 0, 0.5, 1.5};
    const auto value = [&] { return values[random() % 5]; };
    for (std::uint64_t i = 0; i < 400; ++i) {
        const Camera camera = camera_number(i);
        const Vec3 center = {value(), value(), value()};
        // Turned and stretched: touching is asked of the unit ball that it comes from.
        Affine3 map = rotation({30 * value(), 40 * value(), 20});
        const double sizes[] = {0.1, 0.5, 1};
        for (Vec3& row : map.linear.rows)
            row = {sizes[random() % 3] * row.x, row.y * 0.4, sizes[random() % 3] * row.z};
        map.translation = center;
        const std::vector<Vec3> axes = {
            transformed_vector(map, {1, 0, 0}),
            transformed_vector(map, {0, 1, 0}),
            transformed_vector(map, {0, 0, 1})};
        const auto ellipse =
            outline_ellipse(CameraMap(camera), picture_of_600_by_500(), center, axes);
        ASSERT_TRUE(ellipse) << i;
        EXPECT_LE(distance(ellipse->minor, {}), distance(ellipse->major, {}));
        const Affine3 back = *inverse(map);
        for (double angle = 0; angle < 360; angle += 22.5) {
            const Ray ray = ray_through(camera, point_at(*ellipse, angle));
            const Vec3 origin = transformed_point(back, ray.origin);
            const Vec3 direction = normalized(transformed_vector(back, ray.direction));
            const Vec3 nearest = origin - dot(origin, direction) * direction;
            EXPECT_NEAR(length(nearest), 1, 1e-9) << i << ' ' << angle;
        }
    }
}

TEST(OutlineEllipse, OfACircleIsWhereRaysMeetIt) {
    std::mt19937_64 random(2);
    const double values[] = {-2, -1, 0, 0.5, 1.5};
    const auto value = [&] { return values[random() % 5]; };
    int found = 0;
    for (std::uint64_t i = 0; i < 400; ++i) {
        const Camera camera = camera_number(i);
        const Vec3 center = {value(), value(), value()};
        const Affine3 turn = rotation({30 * value(), 40 * value(), 20 * value()});
        const Vec3 normal = transformed_vector(turn, {0, 0, 1});
        const std::vector<Vec3> axes = {
            transformed_vector(turn, {0.7, 0, 0}), transformed_vector(turn, {0, 0.7, 0})};
        const auto ellipse =
            outline_ellipse(CameraMap(camera), picture_of_600_by_500(), center, axes);
        if (!ellipse || distance(ellipse->minor, {}) < 0.1)
            continue; // seen on its edge
        ++found;
        for (double angle = 0; angle < 360; angle += 22.5) {
            const Ray ray = ray_through(camera, point_at(*ellipse, angle));
            const double t = dot(center - ray.origin, normal) / dot(ray.direction, normal);
            EXPECT_NEAR(length(point_at(ray, t) - center), 0.7, 1e-8) << i << ' ' << angle;
        }
    }
    EXPECT_GT(found, 300);
}

TEST(OutlineEllipse, IsNothingWhereTheOutlineIsNone) {
    const Camera camera = camera_number(1); // along z, from z = -8
    const CameraMap map(camera);
    const PictureSettings picture = picture_of_600_by_500();
    const std::vector<Vec3> ball = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    EXPECT_TRUE(outline_ellipse(map, picture, {0, 0, 0}, ball));
    EXPECT_FALSE(outline_ellipse(map, picture, {0, 0, -8.5}, ball)); // the viewer is in it
    EXPECT_FALSE(outline_ellipse(map, picture, {3, 0, -8.5}, ball)); // or beside it
    EXPECT_FALSE(outline_ellipse(map, picture, {0, 0, -12}, ball));  // or before it
    const std::vector<Vec3> disc = {{1, 0, 0}, {0, 0, 1}};
    EXPECT_FALSE(outline_ellipse(map, picture, {0, 0, 0}, disc)); // seen on its edge
    EXPECT_TRUE(outline_ellipse(map, picture, {0, 1, 0}, disc));
}

} // namespace
} // namespace vera
