// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/exact/screen_point.h"

#include <array>
#include <cstdint>

namespace vera {

/// A point of the screen and how near it is: from 0 to depth_size.
struct ScreenVertex {
    ScreenPoint point;
    std::int64_t nearness = 0;

    friend constexpr bool operator==(const ScreenVertex&, const ScreenVertex&) = default;
};

/// The nearness of a triangle's plane, which in the picture is affine: at a point,
/// nearness + (along_x dx + along_y dy) / area, with dx and dy from `at`.
struct DepthPlane {
    ScreenPoint at;
    std::int64_t nearness = 0;
    std::int64_t along_x = 0;
    std::int64_t along_y = 0;
    std::int64_t area = 1; ///< twice that of the triangle; positive

    /// About; off by no more than 2^-48 of the sum of its terms' sizes.
    double value(double x, double y) const {
        return static_cast<double>(nearness)
            + (static_cast<double>(along_x) * (x - at.x)
               + static_cast<double>(along_y) * (y - at.y))
            / static_cast<double>(area);
    }
};

/// The plane of a triangle whose corners go round to the left.
DepthPlane depth_plane(const std::array<ScreenVertex, 3>& corners);

} // namespace vera
