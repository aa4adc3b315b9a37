// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/exact/depth_plane.h"

#include <array>
#include <cmath>

namespace vera {

// Which of two triangles is in front, where both are. What was moved to the grid may pass through
// its neighbour by about a step: a box that stands on a floor does. So the order of two triangles
// is one for all places where both are, that of the places at which they are the farthest apart;
// and only what passes through another by more than a few steps penetrates it.

/// A place of the picture, in steps of the grid.
struct NearnessPlace {
    double x = 0;
    double y = 0;
};

/// The nearness of a plane in double precision: at + along_x (x - place.x) + along_y (y - place.y).
struct NearnessSlope {
    ScreenPoint place;
    double nearness = 0;
    double along_x = 0;
    double along_y = 0;

    double at(NearnessPlace other) const {
        return nearness + along_x * (other.x - place.x) + along_y * (other.y - place.y);
    }

    /// The most by which it may change within a step.
    double per_step() const { return std::abs(along_x) + std::abs(along_y); }
};

NearnessSlope nearness_slope(const DepthPlane& plane);

/// Two planes that are farther apart at a place than their margins together are in a certain order,
/// whatever moving their corners to the grid, and rounding, did to them.
inline double sure_margin(const NearnessSlope& slope) {
    // Products are rounded by 2^-53 of what the plane may change over the picture.
    return (2 + 0x1p-48 * screen_size) * slope.per_step() + 2;
}

struct FrontFace {
    std::array<ScreenVertex, 3> corners;
    NearnessSlope slope;
};

enum class FrontOrder { first, second, coincident, penetrating, unknown };

/// By two places at which both are: unknown where they are too near to each other there.
FrontOrder order_along(
    const NearnessSlope& a, const NearnessSlope& b, const std::array<NearnessPlace, 2>& places);

/// By all places at which both are; never unknown.
FrontOrder order_in_overlap(const FrontFace& a, const FrontFace& b);

} // namespace vera
