// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/exact/screen_point.h"
#include "vera/exact/wide_integer.h"

#include <array>
#include <cstdint>

namespace vera {

/// A point of the screen and how near it is: from 0, infinitely far, to depth_size.
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

/// How much nearer a is than b at the point, times both areas.
Int128 nearness_difference(const DepthPlane& a, const DepthPlane& b, ScreenPoint point);

/// How much that grows along the step.
Int128 nearness_growth(const DepthPlane& a, const DepthPlane& b, ScreenStep along);

static_assert(4 * screen_bits + depth_bits + 5 <= 126, "nearness_difference() must not overflow");

/// Which of two planes is nearer beside a segment, or at its places: what is needed of their
/// difference there.
struct PlaneComparison {
    Int128 at_begin = 0; ///< nearness_difference()
    Int128 at_end = 0;
    int to_left = 0; ///< the sign of nearness_growth() to the left of the segment

    PlaneComparison() = default;
    PlaneComparison(const DepthPlane& a, const DepthPlane& b, ScreenPoint begin, ScreenPoint end);

    /// 1 where a is nearer at the place, -1 where b is, 0 where they are as near.
    int at(SegmentPlace place) const;

    /// Whether neither passes the other between the places.
    bool keeps_order(SegmentPlace first, SegmentPlace last) const;

    /// 1 where a is nearer than b just beside the segment, on the left or on the right, between the
    /// places; 0 where they coincide. Of planes that pass each other there it tells who is nearer
    /// at the middle.
    int beside(SegmentPlace first, SegmentPlace last, bool on_left) const;
};

} // namespace vera
