// SPDX-License-Identifier: Apache-2.0
#pragma once

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
    const double t_of_lowest = lowest / prepared.direction_z;
    const double t_of_highest = highest / prepared.direction_z;
    return {std::min(t_of_lowest, t_of_highest), std::max(t_of_lowest, t_of_highest)};
}

/// The t, in the ray's range, at which the ray meets the plane simple polygon, its boundary
/// included. Nothing for a ray in its plane, nor for one that starts on that plane.
inline std::optional<double>
polygon_crossing(const PreparedRay& prepared, std::span<const Vec3> corners, Vec3 normal) {
    const double speed = dot(normal, prepared.ray.direction);
    if (speed == 0 || !meets_outline(prepared, corners))
        return std::nullopt;

    // A ray that runs almost in the plane gets a t of large error: no farther than the corners.
    const double distance = dot(normal, corners[0] - prepared.ray.origin);
    const auto [first, last] = range_of_corners(prepared, corners);
    const double by_plane = distance / speed;
    const double t = by_plane < first ? first : by_plane > last ? last : by_plane;
    if (!prepared.covers(t))
        return std::nullopt;
    if (prepared.starts_at_origin()) {
        const double bound = prepared.start_distance(max_component(abs(corners[0])));
        if (std::abs(distance)
            <= bound * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z)))
            return std::nullopt;
    }
    return t;
}

} // namespace vera
