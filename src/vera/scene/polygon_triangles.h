// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/vec3.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// Three of a polygon's corners, by their number in it, in the polygon's sense of rotation.
using CornerTriple = std::array<std::uint32_t, 3>;

/// What a polygon looks like from the side that its area vector points to.
enum class OutlineKind : std::uint8_t {
    convex, ///< corners on a straight side are allowed
    simple, ///< not convex, but no side crosses another
    tangled ///< sides cross, or there is no area: not to be split into triangles that cover it once
};

/// Twice the polygon's area, as a vector along its normal by the right-hand rule.
Vec3 doubled_area_vector(std::span<const Vec3> corners);

/// The triangles, n - 2 of them or fewer, that a polygon of n >= 3 corners splits into; a tangled
/// one as well as may be. Convex polygons become a fan round their first corner, others lose ear
/// after ear. Triangles without area are left out. The time is at most proportional to n, with a
/// large factor: of an outline that would take longer, the rest counts as tangled.
OutlineKind split_polygon(std::span<const Vec3> corners, std::vector<CornerTriple>& triangles);

} // namespace vera
