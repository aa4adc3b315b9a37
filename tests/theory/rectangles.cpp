// SPDX-License-Identifier: Apache-2.0
#include "theory/rectangles.h"

#include <algorithm>
#include <cmath>

namespace vera::testing {

std::int32_t any_within(std::int32_t reach, std::mt19937_64& random) {
    const auto values = static_cast<std::uint64_t>(2 * std::int64_t{reach} + 1);
    return static_cast<std::int32_t>(static_cast<std::int64_t>(random() % values) - reach);
}

Rectangles rectangles_within(
    std::size_t count, std::int32_t reach, std::int32_t size, std::mt19937_64& random) {
    Rectangles made;
    for (std::size_t i = 0; i < count; ++i) {
        const std::int32_t x = any_within(reach, random);
        const std::int32_t y = any_within(reach, random);
        const auto side = [&](std::int32_t from) {
            const auto length =
                static_cast<std::int32_t>(random() % (static_cast<std::uint64_t>(size) + 1));
            return std::min(from + length, reach);
        };
        made.push_back({any_within(reach, random), x, side(x), y, side(y)});
    }
    return made;
}

Rectangles repeated_rectangles(std::size_t count, std::mt19937_64& random) {
    const Rectangles few = rectangles_within(3, 2, 3, random);
    Rectangles made;
    for (std::size_t i = 0; i < count; ++i)
        made.push_back(few[random() % few.size()]);
    return made;
}

Rectangles rectangles_along_a_diagonal(std::size_t count, std::mt19937_64& random) {
    Rectangles made;
    for (std::size_t i = 0; i < count; ++i) {
        const auto z = static_cast<std::int32_t>(1000 * i);
        const auto gap = static_cast<std::int32_t>(10 + random() % 41);
        constexpr std::int32_t width = 800;
        const std::uint64_t side = random() % 4;
        IsoRectangle rectangle = {z, z - width / 2, z + width / 2, z - width / 2, z + width / 2};
        std::int32_t& lower = side < 2 ? rectangle.lower_x : rectangle.lower_y;
        std::int32_t& upper = side < 2 ? rectangle.upper_x : rectangle.upper_y;
        lower = side % 2 == 0 ? z + gap : z - gap - width;
        upper = lower + width;
        made.push_back(rectangle);
    }
    return made;
}

WholeRay ray_along_the_diagonal(std::mt19937_64& random) {
    const std::int32_t x = any_within(9, random);
    return {{x, any_within(9, random), 0}, {1, 1, 1}};
}

Rectangles crowd_of_rectangles(std::size_t count, std::mt19937_64& random) {
    Rectangles made = rectangles_within(count - 1, 1000, 2, random);
    constexpr std::int32_t far = 200'000;
    made.push_back({far, far, far, far, far});
    return made;
}

WholeRay ray_in_the_crowd(std::mt19937_64& random) {
    return ray_within(1000, 1000, random);
}

WholeRay ray_within(std::int32_t reach, std::int32_t slope, std::mt19937_64& random) {
    WholeRay ray;
    for (std::int32_t& value : ray.origin)
        value = any_within(reach, random);
    for (std::int32_t& value : ray.direction)
        value = any_within(slope, random);
    if (ray.direction[2] == 0)
        ray.direction[2] = random() % 2 == 0 ? 1 : -1;
    return ray;
}

SlopedRays sloped_rays_within(
    std::size_t count, std::int32_t reach, std::int32_t slope, std::mt19937_64& random) {
    SlopedRays made(count);
    for (SlopedRay& ray : made) {
        ray.slope_x = any_within(slope, random);
        ray.offset_x = any_within(reach, random);
        ray.slope_y = any_within(slope, random);
        ray.offset_y = any_within(reach, random);
        ray.first_z = any_within(reach, random);
    }
    return made;
}

SlopedRays
pencil_of_rays(std::size_t count, std::int32_t reach, std::int32_t slope, std::mt19937_64& random) {
    SlopedRays made(count);
    for (SlopedRay& ray : made) {
        ray.slope_x = any_within(slope, random);
        ray.slope_y = any_within(slope, random);
        ray.offset_x = ray.slope_x * reach;
        ray.offset_y = ray.slope_y * reach;
        ray.first_z = -reach;
    }
    return made;
}

SlopedRays
raster_of_rays(std::size_t count, std::int32_t reach, std::int32_t slope, std::mt19937_64& random) {
    const SlopedRays few = sloped_rays_within(8, reach, slope, random);
    SlopedRays made(count);
    for (SlopedRay& ray : made) {
        const SlopedRay& column = few[random() % few.size()];
        const SlopedRay& row = few[random() % few.size()];
        ray = {column.slope_x, column.offset_x, row.slope_y, row.offset_y, column.first_z};
    }
    return made;
}

SlopedRays
repeated_rays(std::size_t count, std::int32_t reach, std::int32_t slope, std::mt19937_64& random) {
    const SlopedRays few = sloped_rays_within(3, reach, slope, random);
    SlopedRays made(count);
    for (SlopedRay& ray : made)
        ray = few[random() % few.size()];
    return made;
}

SlopedRays nearly_parallel_rays(
    std::size_t count, std::int32_t reach, std::int32_t slope, std::mt19937_64& random) {
    return sloped_rays_within(count, reach, slope / 20, random);
}

const std::vector<RayFamily>& ray_families() {
    static const std::vector<RayFamily> families = {
        {"any", sloped_rays_within},
        {"a pencil", pencil_of_rays},
        {"a raster", raster_of_rays},
        {"repeated", repeated_rays}};
    return families;
}

Crowd crowd_of(
    std::size_t count,
    decltype(RayFamily::rays) rays,
    std::int32_t slope,
    std::mt19937_64& random) {
    constexpr std::int32_t reach = 20000;
    const double side = 2 * reach / std::sqrt(static_cast<double>(count));
    Crowd made;
    made.rectangles = rectangles_within(count, reach, static_cast<std::int32_t>(side), random);
    made.rays = rays(count, reach, slope, random);
    return made;
}

} // namespace vera::testing
