// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/vec3.h"

#include <cstddef>

namespace vera {

/// On which side of the plane through a, b and c the point d lies: 1 where the normal
/// (b-a) x (c-a) points to, -1 on the other side, 0 on the plane, or where a, b and c are on one
/// line. Exact for all finite coordinates.
int orientation(Vec3 a, Vec3 b, Vec3 c, Vec3 d);

/// The sign of the component along that axis of (b-a) x (c-a), exactly: on which side of the line
/// from a to b the point c is seen along the axis.
int orientation_along(std::size_t axis, Vec3 a, Vec3 b, Vec3 c);

} // namespace vera
