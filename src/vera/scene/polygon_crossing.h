// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/prepared_ray.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <span>

namespace vera {

/// How the sheared polygon lies round the ray: whether the ray meets it, its boundary included, and
/// between which z.
struct PolygonOutline {
    bool met = false;
    double lowest_z = std::numeric_limits<double>::infinity();
    double highest_z = -std::numeric_limits<double>::infinity();
};

/// Exact for the sheared corners, but that points within rounding of an edge count as on it.
inline PolygonOutline outline(const PreparedRay& prepared, std::span<const Vec3> corners) {
    PolygonOutline result;
    bool on_boundary = false;
    int turns = 0; // of the outline about the ray
    ShearedPoint from = sheared(prepared, corners.back());
    for (const Vec3& corner : corners) {
        const ShearedPoint to = sheared(prepared, corner);
        result.lowest_z = std::min(result.lowest_z, to.z);
        result.highest_z = std::max(result.highest_z, to.z);
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
    result.met = on_boundary || turns != 0;
    return result;
}

/// The t, in the ray's range, at which the ray meets the plane simple polygon, its boundary
/// included. Nothing for a ray in its plane, nor for one that starts on that plane.
inline std::optional<double>
polygon_crossing(const PreparedRay& prepared, std::span<const Vec3> corners, Vec3 normal) {
    const PolygonOutline seen = outline(prepared, corners);
    if (!seen.met)
        return std::nullopt;
    const double speed = dot(normal, prepared.ray.direction);
    const Vec3 from_origin = corners[0] - prepared.ray.origin;
    const double distance = dot(normal, from_origin);
    if (speed == 0)
        return std::nullopt;

    // A ray that runs almost in the plane gets a t of large error: no farther than the corners.
    const double z_bounds[] = {
        seen.lowest_z / prepared.direction_z, seen.highest_z / prepared.direction_z};
    const double first = std::min(z_bounds[0], z_bounds[1]);
    const double last = std::max(z_bounds[0], z_bounds[1]);
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
