// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/vec3.h"

#include <array>
#include <cstdint>

namespace vera {

using TriangleCorners = std::array<Vec3, 3>;

/// What two triangles have to do with each other.
enum class TriangleRelation : std::uint8_t {
    apart,    ///< they have no point in common that is inside of both; they may touch
    crossing, ///< each goes through the inside of the other, or both through an end of a common
              ///< line
    covering  ///< they lie in one plane, and have an area in common
};

/// Exact. Triangles on one line are apart from all.
TriangleRelation relation(const TriangleCorners& a, const TriangleCorners& b);

} // namespace vera
