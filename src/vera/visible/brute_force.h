// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/exact/wide_integer.h"
#include "vera/visible/screen_scene.h"

#include <array>
#include <cstdint>

namespace vera {

/// Where a point in half steps of the grid lies: 1 within the triangle, 0 on a side, -1 outside.
int inclusion(const std::array<ScreenVertex, 3>& corners, std::int64_t x, std::int64_t y);

/// Twice how near a plane is at a point, as a fraction.
struct DoubledNearness {
    Int128 numerator;
    Int128 denominator; ///< positive

    /// Negative, 0 or positive as a is less near than b, as near, or nearer.
    friend int order(const DoubledNearness& a, const DoubledNearness& b) {
        return sign_of_difference(a.numerator, b.denominator, b.numerator, a.denominator);
    }
};

/// At the point in half steps, which lies in the triangle that spans the plane.
DoubledNearness doubled_nearness(const DepthPlane& plane, std::int64_t x, std::int64_t y);

/// What is seen at the middle of the square of the grid that begins at the point, by asking every
/// triangle: the reference for everything faster. Nothing is told of points on the side of a
/// triangle: has_side_at is then set.
struct SeenAt {
    std::uint32_t source = 0; ///< or no_source
    LightSet unlit = 0;       ///< the lights that do not reach it there
    bool has_side_at = false;
};

/// point is in half steps of the grid.
SeenAt seen_at(const ScreenScene& scene, std::int64_t x_in_halves, std::int64_t y_in_halves);

} // namespace vera
