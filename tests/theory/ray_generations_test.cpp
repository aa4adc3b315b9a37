// SPDX-License-Identifier: Apache-2.0
#include "vera/math/vec3.h"
#include "vera/theory/ray_generations.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr std::int32_t reach = 20'000;
constexpr std::size_t count = 300;

/// Pairs of rays that change places, seen along y, where both have begun and within the cube.
std::size_t crossings(std::span<const SlopedRay> rays) {
    std::size_t found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const std::int32_t first = std::max(rays[i].first_z, rays[j].first_z);
            const auto apart = [&](std::int32_t z) {
                return value_at(x_point(rays[i]), z) - value_at(x_point(rays[j]), z);
            };
            const std::int64_t before = apart(first);
            const std::int64_t after = apart(reach);
            found += (before < 0 && after > 0) || (before > 0 && after < 0) ? 1 : 0;
        }
    return found;
}

TEST(RayGenerations, CrossOnlyOnceTheyAreMirrored) {
    std::mt19937_64 random(3);
    EXPECT_EQ(crossings(first_generation(count, random)), 0U);
    const std::size_t mirrored = crossings(mirrored_generation(count, random));
    EXPECT_GT(mirrored, count);
    EXPECT_LT(mirrored, count * count / 4);
}

TEST(RayGenerations, OfAViewerComeFromOnePoint) {
    std::mt19937_64 random(4);
    std::set<std::int32_t> slopes;
    for (const SlopedRay& ray : first_generation(count, random)) {
        EXPECT_EQ(ray.first_z, -reach);
        EXPECT_EQ(value_at(x_point(ray), -reach), 0);
        EXPECT_EQ(value_at(y_point(ray), -reach), 0);
        EXPECT_LE(std::abs(value_at(x_point(ray), reach)), std::int64_t{fine_steps} * reach);
        slopes.insert(ray.slope_x);
    }
    EXPECT_GT(slopes.size(), count / 2);
}

/// How far from the viewer the ray passes that, mirrored once more where it leaves the sphere,
/// leads back.
double miss_of_viewer(Vec3 place, Vec3 direction) {
    const Vec3 viewer = {reach / 2.0, reach / 4.0, reach};
    const Vec3 center = {0, 0, -reach};
    const Vec3 normal = normalized(place - center);
    const Vec3 leaving = normalized(direction);
    // The way back is the mirror image of leaving about the normal.
    const Vec3 back = 2 * dot(leaving, normal) * normal - leaving;
    const Vec3 to_viewer = viewer - place;
    return length(to_viewer - dot(to_viewer, back) * back);
}

TEST(RayGenerations, AreMirroredByASphere) {
    std::mt19937_64 random(5);
    for (const SlopedRay& ray : mirrored_generation(count, random)) {
        EXPECT_LE(std::abs(ray.slope_x), fine_steps);
        EXPECT_LE(std::abs(ray.slope_y), fine_steps);
        const Vec3 direction = {
            static_cast<double>(ray.slope_x) / fine_steps,
            static_cast<double>(ray.slope_y) / fine_steps,
            1};
        const Vec3 begin = {
            static_cast<double>(value_at(x_point(ray), ray.first_z)) / fine_steps,
            static_cast<double>(value_at(y_point(ray), ray.first_z)) / fine_steps,
            static_cast<double>(ray.first_z)};
        // It begins within a step of z of the sphere, and slopes are a thousandth off at most.
        EXPECT_NEAR(length(begin - Vec3{0, 0, -reach}), reach / 2.0, 2);
        EXPECT_LT(miss_of_viewer(begin, direction), 60);
    }
    for (std::size_t i = 0; i < count; ++i) {
        const WholeRay ray = mirrored_generation_ray(random);
        const Vec3 origin = {
            static_cast<double>(ray.origin[0]),
            static_cast<double>(ray.origin[1]),
            static_cast<double>(ray.origin[2])};
        const Vec3 direction = {
            static_cast<double>(ray.direction[0]),
            static_cast<double>(ray.direction[1]),
            static_cast<double>(ray.direction[2])};
        EXPECT_GT(ray.direction[2], 0);
        EXPECT_LT(miss_of_viewer(origin, direction), 60);
    }
}

TEST(RayGenerations, HaveRectanglesOfTheirCube) {
    std::mt19937_64 random(6);
    const std::vector<IsoRectangle> made = finely_scattered_rectangles(count, 2, random);
    require_rectangles(made);
    for (const IsoRectangle& rectangle : made) {
        EXPECT_LE(std::abs(rectangle.z), reach);
        EXPECT_LE(std::abs(rectangle.lower_x), fine_steps * reach);
        EXPECT_EQ(rectangle.upper_y % fine_steps, 0);
    }
    require_sloped_rays(mirrored_generation(count, random));
}

} // namespace
} // namespace vera
