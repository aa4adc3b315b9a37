// SPDX-License-Identifier: Apache-2.0
// Rectangles and rays of few values, on which everything coincides that can: and of any, and of the
// largest.
#pragma once

#include "vera/theory/sloped_ray.h"

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace vera::testing {

using Rectangles = std::vector<IsoRectangle>;
using SlopedRays = std::vector<SlopedRay>;

/// A whole number of -reach to reach.
std::int32_t any_within(std::int32_t reach, std::mt19937_64& random);

/// Corners within the reach, z as well; sides of at most the size, some of them none.
Rectangles rectangles_within(
    std::size_t count, std::int32_t reach, std::int32_t size, std::mt19937_64& random);

/// Many copies of three.
Rectangles repeated_rectangles(std::size_t count, std::mt19937_64& random);

/// So many beside the line x = y = z, one a step of 1000, all within 50 of it and none nearer than
/// 10, on any of its four sides: a box around two of them contains a part of the line.
Rectangles rectangles_along_a_diagonal(std::size_t count, std::mt19937_64& random);

/// A ray parallel to that line, which is nearer to it than any of the rectangles.
WholeRay ray_along_the_diagonal(std::mt19937_64& random);

/// So many in a crowd within 1000, each a millionth of the crowd's faces, and one so far away that
/// a grid over all has them in one cell.
Rectangles crowd_of_rectangles(std::size_t count, std::mt19937_64& random);

/// A ray of any direction from within the crowd.
WholeRay ray_in_the_crowd(std::mt19937_64& random);

/// Origin within the reach, components of the direction within the slope; its z is not 0.
WholeRay ray_within(std::int32_t reach, std::int32_t slope, std::mt19937_64& random);

/// Slopes within the slope, places within the reach at z = 0, beginning anywhere within the reach.
SlopedRays sloped_rays_within(
    std::size_t count, std::int32_t reach, std::int32_t slope, std::mt19937_64& random);

/// All through one point at z = -reach, as those of a viewer: they cross nowhere else. Beginning
/// there.
SlopedRays
pencil_of_rays(std::size_t count, std::int32_t reach, std::int32_t slope, std::mt19937_64& random);

/// In rows and columns of a raster: many share one of their two points.
SlopedRays
raster_of_rays(std::size_t count, std::int32_t reach, std::int32_t slope, std::mt19937_64& random);

/// Many copies of three.
SlopedRays
repeated_rays(std::size_t count, std::int32_t reach, std::int32_t slope, std::mt19937_64& random);

/// Of nearly one direction: slopes of a 20th of the slope.
SlopedRays nearly_parallel_rays(
    std::size_t count, std::int32_t reach, std::int32_t slope, std::mt19937_64& random);

/// A way to make so many rays.
struct RayFamily {
    const char* name;
    SlopedRays (*rays)(
        std::size_t count, std::int32_t reach, std::int32_t slope, std::mt19937_64& random);
};

/// All of these.
const std::vector<RayFamily>& ray_families();

/// As many rays as rectangles, which are as far apart as they are wide.
struct Crowd {
    Rectangles rectangles;
    SlopedRays rays;
};

Crowd crowd_of(
    std::size_t count, decltype(RayFamily::rays) rays, std::int32_t slope, std::mt19937_64& random);

} // namespace vera::testing
