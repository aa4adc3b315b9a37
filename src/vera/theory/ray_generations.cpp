// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/ray_generations.h"

#include "vera/math/vec3.h"
#include "vera/theory/scattered_rectangles.h"
#include "vera/theory/whole_within.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vera {

namespace {

/// That of scattered rectangles.
constexpr std::int32_t reach = 20'000;
constexpr std::int32_t steepest_in_cube = fine_steps / 2; ///< of a viewer's rays
constexpr std::int32_t sphere_radius = reach / 2;

struct MirroredRay {
    Vec3 origin;
    Vec3 direction;
};

/// From the sphere's surface; goes on along z, and not by less than along x or y.
MirroredRay mirrored_ray(std::mt19937_64& random) {
    constexpr Vec3 viewer = {reach / 2.0, reach / 4.0, reach};
    constexpr Vec3 center = {0, 0, -reach};
    while (true) {
        const std::int32_t across = whole_within(sphere_radius, random);
        const std::int32_t upward = whole_within(sphere_radius, random);
        const Vec3 seen = {static_cast<double>(across), static_cast<double>(upward), -reach};
        const Vec3 arriving = normalized(seen - viewer);
        const double half = dot(center - viewer, arriving);
        const double square =
            dot(center - viewer, center - viewer) - double{sphere_radius} * double{sphere_radius};
        if (half * half < square)
            continue; // goes by
        const Vec3 place = viewer + (half - std::sqrt(half * half - square)) * arriving;
        const Vec3 normal = normalized(place - center);
        const Vec3 leaving = arriving - 2 * dot(arriving, normal) * normal;
        if (leaving.z >= std::max(std::abs(leaving.x), std::abs(leaving.y)))
            return {place, leaving};
    }
}

std::int32_t nearest_whole(double value) {
    return static_cast<std::int32_t>(std::lround(value));
}

/// Of the coordinate that is at the place and grows by the slope, where z is 0.
std::int32_t offset_of(double place, std::int32_t slope, double z) {
    return nearest_whole(fine_steps * place - slope * z);
}

} // namespace

std::vector<IsoRectangle>
finely_scattered_rectangles(std::size_t count, double parts, std::mt19937_64& random) {
    std::vector<IsoRectangle> made = scattered_rectangles(count, parts, random);
    for (IsoRectangle& rectangle : made)
        for (std::int32_t* side :
             {&rectangle.lower_x, &rectangle.upper_x, &rectangle.lower_y, &rectangle.upper_y})
            *side *= fine_steps;
    return made;
}

std::vector<SlopedRay> rays_of_viewer(
    std::size_t count, std::int32_t distance, std::int32_t steepest, std::mt19937_64& random) {
    std::vector<SlopedRay> made(count);
    for (SlopedRay& ray : made) {
        ray.slope_x = whole_within(steepest, random);
        ray.slope_y = whole_within(steepest, random);
        ray.offset_x = distance * ray.slope_x;
        ray.offset_y = distance * ray.slope_y;
        ray.first_z = -distance;
    }
    return made;
}

std::vector<SlopedRay> first_generation(std::size_t count, std::mt19937_64& random) {
    return rays_of_viewer(count, reach, steepest_in_cube, random);
}

std::vector<SlopedRay> mirrored_generation(std::size_t count, std::mt19937_64& random) {
    std::vector<SlopedRay> made(count);
    for (SlopedRay& ray : made) {
        const MirroredRay mirrored = mirrored_ray(random);
        const Vec3& direction = mirrored.direction;
        ray.slope_x = nearest_whole(fine_steps * direction.x / direction.z);
        ray.slope_y = nearest_whole(fine_steps * direction.y / direction.z);
        ray.offset_x = offset_of(mirrored.origin.x, ray.slope_x, mirrored.origin.z);
        ray.offset_y = offset_of(mirrored.origin.y, ray.slope_y, mirrored.origin.z);
        ray.first_z = static_cast<std::int32_t>(std::ceil(mirrored.origin.z));
    }
    return made;
}

WholeRay first_generation_ray(std::mt19937_64& random) {
    WholeRay ray;
    ray.origin = {0, 0, -reach};
    ray.direction[0] = whole_within(steepest_in_cube, random);
    ray.direction[1] = whole_within(steepest_in_cube, random);
    ray.direction[2] = fine_steps;
    return ray;
}

WholeRay mirrored_generation_ray(std::mt19937_64& random) {
    const auto [origin, direction] = mirrored_ray(random);
    return {
        {nearest_whole(origin.x), nearest_whole(origin.y), nearest_whole(origin.z)},
        {nearest_whole(fine_steps * direction.x),
         nearest_whole(fine_steps * direction.y),
         nearest_whole(fine_steps * direction.z)}};
}

} // namespace vera
