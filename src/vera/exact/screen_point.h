// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/exact/wide_integer.h"

#include <compare>
#include <cstdint>

namespace vera {

/// Points of the picture, before anything is decided about them, are moved to the nearest crossing
/// of a grid of so many steps each way, and depths to a scale of so many. From then on nothing is
/// rounded: the lengths of all numbers that follow fit their types.
constexpr int screen_bits = 22;
constexpr int depth_bits = 32;
constexpr std::int32_t screen_size = std::int32_t{1} << screen_bits;
constexpr std::int64_t depth_size = std::int64_t{1} << depth_bits;

/// A point of the grid, both coordinates from 0 to screen_size.
struct ScreenPoint {
    std::int32_t x = 0;
    std::int32_t y = 0;

    friend constexpr bool operator==(ScreenPoint, ScreenPoint) = default;
    friend constexpr auto operator<=>(ScreenPoint, ScreenPoint) = default;
};

/// From one point to another.
struct ScreenStep {
    std::int64_t x = 0;
    std::int64_t y = 0;
};

constexpr ScreenStep step(ScreenPoint from, ScreenPoint to) {
    return {std::int64_t{to.x} - from.x, std::int64_t{to.y} - from.y};
}

/// Twice the area of the triangle from the origin to a and b: positive where b lies to the left of
/// a, if y grows upward.
constexpr std::int64_t cross(ScreenStep a, ScreenStep b) {
    return a.x * b.y - a.y * b.x;
}

/// Twice the area of the triangle: positive where c lies to the left of the way from a to b.
constexpr std::int64_t orientation(ScreenPoint a, ScreenPoint b, ScreenPoint c) {
    return cross(step(a, b), step(a, c));
}

static_assert(2 * screen_bits + 2 < 63, "orientation() must not overflow");

/// A place on the way along a segment, from 0 at its beginning to 1 at its end.
struct SegmentPlace {
    std::int64_t numerator = 0;
    std::int64_t denominator = 1; ///< positive

    double value() const {
        return static_cast<double>(numerator) / static_cast<double>(denominator);
    }
};

/// Negative, 0 or positive as a comes before, at or behind b.
constexpr int order(SegmentPlace a, SegmentPlace b) {
    return sign(Int128{a.numerator} * b.denominator - Int128{b.numerator} * a.denominator);
}

static_assert(4 * screen_bits + 4 < 127, "order() must not overflow");

/// Where the line from a to b crosses the one from p to q, which is not parallel to it.
SegmentPlace crossing_place(ScreenPoint a, ScreenPoint b, ScreenPoint p, ScreenPoint q);

/// Where the point, which lies on the line from a to b, is on it.
SegmentPlace place_on(ScreenPoint a, ScreenPoint b, ScreenPoint point);

/// A point whose coordinates are fractions, in lowest terms: two are equal only if their members
/// are.
struct RationalPoint {
    ScreenPoint whole;
    std::int64_t x_numerator = 0; ///< from 0 to below denominator
    std::int64_t y_numerator = 0;
    std::int64_t denominator = 1;

    double x() const {
        return whole.x + static_cast<double>(x_numerator) / static_cast<double>(denominator);
    }

    double y() const {
        return whole.y + static_cast<double>(y_numerator) / static_cast<double>(denominator);
    }

    friend constexpr bool operator==(const RationalPoint&, const RationalPoint&) = default;
};

/// The point at a place on the segment from a to b, not beside its ends.
RationalPoint point_at(ScreenPoint a, ScreenPoint b, SegmentPlace place);

/// Orders points by x and then by y.
int order(const RationalPoint& a, const RationalPoint& b);

} // namespace vera
