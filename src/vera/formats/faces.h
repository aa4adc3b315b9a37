// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/vec3.h"
#include "vera/scene/geometry.h"
#include "vera/scene/primitives.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

namespace vera {

/// The unit normal (p2-p1) x (p3-p1) of a triangle; nothing when it has no area: when rounding the
/// corners' coordinates could have made all of it.
std::optional<Vec3> triangle_normal(std::span<const Vec3, 3> corners);

/// What a list of corners is.
struct PolygonForm {
    enum class Kind {
        convex,
        simple,
        no_area,     ///< all corners on one line, or the parts of the area cancel
        not_plane,   ///< normal is of no use
        crossing,    ///< the sides in crossing_sides cross
        too_involved ///< so many sides lie side by side that finding crossings would take too long
    };

    Kind kind = Kind::no_area;
    Vec3 normal = {}; ///< unit, in the direction of the area vector
    std::pair<std::size_t, std::size_t> crossing_sides = {}; ///< side i begins at corner i
};

/// P4: plane when the lines of the diagonals pass within 1e-6 of the longer one.
PolygonForm quadrangle_form(std::span<const Vec3, 4> corners);

/// PN: plane when all corners lie within 1e-6 of the polygon's largest extent. Too involved when
/// more pairs of sides than this would have to be looked at.
PolygonForm polygon_form(std::span<const Vec3> corners, std::uint64_t most_side_pairs);

/// On which side of a face the inner point lies, as the outside that follows from it; nothing when
/// it lies in the face's plane: when its distance from the plane is at most 1e-9 of that from the
/// face's first corner.
std::optional<Outside> outside_of(Vec3 unit_normal, Vec3 first_corner, Vec3 inner_point);

} // namespace vera
