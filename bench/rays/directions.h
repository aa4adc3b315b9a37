// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/elementary.h"
#include "vera/math/vec3.h"

#include <cmath>
#include <cstddef>

namespace vera {

/// Two unit vectors that make a right angle with a direction and with each other.
struct Across {
    Vec3 right;
    Vec3 forward;
};

inline Across across(Vec3 direction) {
    const Vec3 other = std::abs(direction.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 right = normalized(cross(direction, other));
    return {right, cross(direction, right)};
}

/// The unit vector at an angle from the first of the two.
inline Vec3 turned(const Across& plane, double angle) {
    return cos_degrees(angle) * plane.right + sin_degrees(angle) * plane.forward;
}

/// The direction bent away from itself by an angle, to the side that another angle gives.
inline Vec3 bent(Vec3 direction, double angle, double turn) {
    return normalized(
        cos_degrees(angle) * direction + sin_degrees(angle) * turned(across(direction), turn));
}

/// Part i of count of a whole turn, which is exactly 360, so that what goes round closes without a
/// gap.
inline double degrees(std::size_t i, std::size_t count) {
    return 360 * static_cast<double>(i) / static_cast<double>(count);
}

} // namespace vera
