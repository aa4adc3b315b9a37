// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/axial_ray.h"
#include "vera/scene/primitives.h"

#include <array>
#include <cstddef>

namespace vera {

/// Where the whole line of a ray crosses one piece of a contour, in no certain order. A piece has
/// at most 6; rounding near points of contact could give a few more.
struct PieceCrossings {
    std::size_t count = 0;
    std::array<double, 16> t = {};
};

/// The crossings with any piece, found without tessellation by a search that misses none but
/// contacts within rounding. Whether the line passes inside or outside of a contour's corner is
/// decided alike for both pieces that meet there, so that it cannot slip through between them.
PieceCrossings
certified_crossings(const AxialRay& axial, const ContourPiece& piece, ContourPiece::Point start);

/// The same without the crossing at which the ray starts, where it starts on the piece: by the
/// caller's word or to within rounding.
PieceCrossings crossings_beyond_start(
    const PreparedRay& prepared,
    const AxialRay& axial,
    const RotationalShape& shape,
    std::size_t piece,
    bool starts_here);

/// How near its origin a contour passes that the ray starts on.
double start_distance(const PreparedRay& prepared, const RotationalShape& shape, double reach);

} // namespace vera
