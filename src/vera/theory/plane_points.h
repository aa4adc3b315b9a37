// SPDX-License-Identifier: Apache-2.0
// Points of the plane that are hard on trees: few values, lines, circles, and the largest numbers.
// Curves are counted of them, and answers compared. The same on every machine.
#pragma once

#include "vera/theory/plane_strip.h"

#include <cstddef>
#include <random>
#include <vector>

namespace vera {

using PlanePoints = std::vector<PlanePoint>;

/// A way to make so many points.
struct PointFamily {
    const char* name;
    PlanePoints (*points)(std::size_t count, std::mt19937_64& random);
    const char* place; ///< where they are, for people
};

/// All over a square.
PlanePoints scattered_points(std::size_t count, std::mt19937_64& random);
/// In convex position.
PlanePoints circle_points(std::size_t count, std::mt19937_64& random);
/// Along a diagonal, so thin that cuts along the axes would do nothing for long.
PlanePoints thin_diagonal_points(std::size_t count, std::mt19937_64& random);
/// In a square lattice: very many on common lines.
PlanePoints lattice_points(std::size_t count, std::mt19937_64& random);
/// On few lines across x, as boxes with few values of z are.
PlanePoints column_points(std::size_t count, std::mt19937_64& random);
/// On one line, some of them several times.
PlanePoints collinear_points(std::size_t count, std::mt19937_64& random);
/// Of very few values: most of them many times.
PlanePoints repeated_points(std::size_t count, std::mt19937_64& random);
/// Ever closer to one another.
PlanePoints crowded_points(std::size_t count, std::mt19937_64& random);
/// At the largest coordinates, and at 0.
PlanePoints extreme_points(std::size_t count, std::mt19937_64& random);

/// All of these.
const std::vector<PointFamily>& point_families();

/// A half-plane or a strip with borders through points, or beside them by one.
PlaneStrip strip_near(const PlanePoints& points, PlaneDirection normal, std::mt19937_64& random);

/// A half-plane, likewise.
PlaneStrip
half_plane_near(const PlanePoints& points, PlaneDirection normal, std::mt19937_64& random);

/// A normal of few values, or across the way between two points, or any one.
PlaneDirection some_normal(const PlanePoints& points, std::mt19937_64& random);

} // namespace vera
