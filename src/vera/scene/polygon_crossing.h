// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/box3.h"
#include "vera/scene/outline_table.h"
#include "vera/scene/prepared_ray.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <utility>

namespace vera {

/// Whether the ray meets the polygon as the ray sees it, its boundary included. Exact for the
/// sheared corners, but that points within rounding of an edge count as on it.
inline bool meets_outline(const PreparedRay& prepared, std::span<const Vec3> corners) {
    bool on_boundary = false;
    int turns = 0; // of the outline about the ray
    ShearedPoint from = sheared(prepared, corners.back());
    for (const Vec3& corner : corners) {
        const ShearedPoint to = sheared(prepared, corner);
        if ((from.y <= 0) != (to.y <= 0)) {
            const double side = edge_function(from, to);
            on_boundary = on_boundary || side == 0;
            // Upwards to the right of the ray, or downwards to the left of its half line.
            if (from.y <= 0)
                turns += side > 0 ? 1 : 0;
            else
                turns -= side < 0 ? 1 : 0;
        } else if (from.y == 0 && to.y == 0) {
            on_boundary = on_boundary || (from.x <= 0 && to.x >= 0) || (from.x >= 0 && to.x <= 0);
        }
        on_boundary = on_boundary || (to.x == 0 && to.y == 0);
        from = to;
    }
    return on_boundary || turns != 0;
}

namespace detail {

inline std::pair<double, double>
range_between(const PreparedRay& prepared, double lowest, double highest) {
    const double t_of_lowest = lowest / prepared.direction_z;
    const double t_of_highest = highest / prepared.direction_z;
    return {std::min(t_of_lowest, t_of_highest), std::max(t_of_lowest, t_of_highest)};
}

/// The t at which the ray, which meets the plane through the corner at this distance along the
/// normal over this speed, meets the polygon if it meets its outline.
inline std::optional<double> plane_crossing(
    const PreparedRay& prepared,
    const Vec3& corner,
    const Vec3& normal,
    double distance,
    double by_plane,
    const std::pair<double, double>& range) {
    // A ray that runs almost in the plane gets a t of large error: no farther than the corners.
    const auto [first, last] = range;
    const double t = by_plane < first ? first : by_plane > last ? last : by_plane;
    if (!prepared.covers(t))
        return std::nullopt;
    if (prepared.starts_at_origin()) {
        const double bound = prepared.start_distance(max_component(abs(corner)));
        if (std::abs(distance)
            <= bound * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z)))
            return std::nullopt;
    }
    return t;
}

} // namespace detail

/// The least and the largest t at which the ray passes a corner.
inline std::pair<double, double>
range_of_corners(const PreparedRay& prepared, std::span<const Vec3> corners) {
    const double origin_z = prepared.ray.origin.*prepared.z_axis;
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    for (const Vec3& corner : corners) {
        const double z = corner.*prepared.z_axis - origin_z;
        lowest = std::min(lowest, z);
        highest = std::max(highest, z);
    }
    return detail::range_between(prepared, lowest, highest);
}

/// The same of the corners that have these bounds: rounding keeps order, so that the differences'
/// extremes are those of the bounds.
inline std::pair<double, double> range_of_corners(const PreparedRay& prepared, const Box3& bounds) {
    const double origin_z = prepared.ray.origin.*prepared.z_axis;
    return detail::range_between(
        prepared,
        bounds.lower.*prepared.z_axis - origin_z,
        bounds.upper.*prepared.z_axis - origin_z);
}

/// The t, in the ray's range, at which the ray meets the plane simple polygon, its boundary
/// included. Nothing for a ray in its plane, nor for one that starts on that plane.
inline std::optional<double>
polygon_crossing(const PreparedRay& prepared, std::span<const Vec3> corners, Vec3 normal) {
    const double speed = dot(normal, prepared.ray.direction);
    if (speed == 0 || !meets_outline(prepared, corners))
        return std::nullopt;
    const double distance = dot(normal, corners[0] - prepared.ray.origin);
    return detail::plane_crossing(
        prepared,
        corners[0],
        normal,
        distance,
        distance / speed,
        range_of_corners(prepared, corners));
}

/// The same to the bit, by an outline of the table: goes through the sides near the ray alone, or
/// through none.
inline std::optional<double> polygon_crossing(
    const PreparedRay& prepared,
    std::span<const Vec3> corners,
    Vec3 normal,
    const OutlineTable& table,
    const OutlineStrips& outline) {
    const double speed = dot(normal, prepared.ray.direction);
    if (speed == 0)
        return std::nullopt;
    const double distance = dot(normal, corners[0] - prepared.ray.origin);
    const double by_plane = distance / speed;
    const std::optional<double> t = detail::plane_crossing(
        prepared,
        corners[0],
        normal,
        distance,
        by_plane,
        range_of_corners(prepared, outline.bounds));
    if (!t)
        return std::nullopt;
    const InclusionStatus status =
        inclusion_status(table, outline, corners, prepared, by_plane, speed);
    const bool met = status == InclusionStatus::uncertain ? meets_outline(prepared, corners)
                                                          : status == InclusionStatus::inside;
    return met ? t : std::nullopt;
}

} // namespace vera
