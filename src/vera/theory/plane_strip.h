// SPDX-License-Identifier: Apache-2.0
// Points of the plane with whole coordinates, and the half-planes and strips that are asked for.
// What decides anything is a whole number of at most 63 bits: nothing is rounded, and nothing
// overflows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace vera {

/// The largest magnitude of a coordinate.
constexpr std::int32_t largest_plane_coordinate = std::int32_t{1} << 30;

/// The largest magnitude of a component of a normal or a direction: that of a way between points.
constexpr std::int64_t largest_plane_direction = std::int64_t{1} << 31;

/// The sum of two products of a coordinate and a component.
static_assert(
    2
        * (static_cast<double>(largest_plane_coordinate)
           * static_cast<double>(largest_plane_direction))
    < static_cast<double>(std::numeric_limits<std::int64_t>::max()));

struct PlanePoint {
    std::int32_t x = 0;
    std::int32_t y = 0;

    friend constexpr bool operator==(PlanePoint, PlanePoint) = default;
};

/// A way of lines, or the normal of some; need not be unit.
struct PlaneDirection {
    std::int64_t x = 0;
    std::int64_t y = 0;

    friend constexpr bool operator==(PlaneDirection, PlaneDirection) = default;
};

constexpr PlaneDirection operator-(PlaneDirection direction) {
    return {-direction.x, -direction.y};
}

constexpr PlaneDirection direction_between(PlanePoint from, PlanePoint to) {
    return {std::int64_t{to.x} - from.x, std::int64_t{to.y} - from.y};
}

constexpr std::int64_t dot(PlaneDirection direction, PlanePoint point) {
    return direction.x * point.x + direction.y * point.y;
}

/// How far the point lies to the left of the line along the direction through (0, 0), in units of
/// the direction's length.
constexpr std::int64_t offset(PlaneDirection direction, PlanePoint point) {
    return direction.x * point.y - direction.y * point.x;
}

/// The points p with lowest <= dot(normal, p) <= highest: a half-plane where one of the two is left
/// as it is. Both borders belong to it. As everything is whole, no point lies on the line half a
/// unit outside a border, and that is the line that parts what is in from what is out.
struct PlaneStrip {
    PlaneDirection normal;
    std::int64_t lowest = std::numeric_limits<std::int64_t>::min();
    std::int64_t highest = std::numeric_limits<std::int64_t>::max();
};

constexpr bool contains(const PlaneStrip& strip, PlanePoint point) {
    const std::int64_t at = dot(strip.normal, point);
    return strip.lowest <= at && at <= strip.highest;
}

/// Throws std::invalid_argument where a coordinate is larger than largest_plane_coordinate.
void require_plane_points(std::span<const PlanePoint> points);

/// Throws std::invalid_argument where a component of the normal is larger than
/// largest_plane_direction.
void require_plane_strip(const PlaneStrip& strip);

/// The reference of all that answers quickly: the numbers of the points in the strip, in their
/// order. Looks at each point.
std::vector<std::uint32_t>
brute_force_numbers_in(std::span<const PlanePoint> points, const PlaneStrip& strip);

} // namespace vera
