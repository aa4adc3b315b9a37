// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/prepared_ray.h"

#include <optional>

namespace vera {

namespace detail {

/// Whether the ray starts on the plane of the triangle, to within rounding.
inline bool starts_on_triangle(const PreparedRay& prepared, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const Vec3 normal = cross(ab, ac);
    const Vec3 from_origin = a - prepared.ray.origin;
    const double size = max_component(max(abs(a), max(abs(b), abs(c))));
    const auto sum = [](Vec3 v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); };
    // The second part is the rounding of the normal itself, which is what counts for slivers.
    const double bound = prepared.start_distance(size) * sum(normal)
        + 0x1p-50 * sum(ab) * sum(ac) * max_component(abs(from_origin));
    return std::abs(dot(normal, from_origin)) <= bound;
}

} // namespace detail

/// The t, in the ray's range, at which the ray meets the triangle, its edges and corners included.
/// Nothing for a ray in the triangle's plane, nor for one that starts on that plane.
inline std::optional<double>
triangle_crossing(const PreparedRay& prepared, Vec3 a, Vec3 b, Vec3 c) {
    const ShearedPoint p = sheared(prepared, a);
    const ShearedPoint q = sheared(prepared, b);
    const ShearedPoint r = sheared(prepared, c);
    const double u = edge_function(q, r);
    const double v = edge_function(r, p);
    const double w = edge_function(p, q);
    // What is not a number fails both.
    if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)))
        return std::nullopt;
    const double area = u + v + w;
    if (area == 0)
        return std::nullopt;

    // A mean of the corners, so that t stays between theirs however flat the ray comes in.
    const double t = (u * p.z + v * q.z + w * r.z) / (area * prepared.direction_z);
    if (!prepared.covers(t))
        return std::nullopt;
    if (prepared.starts_at_origin() && detail::starts_on_triangle(prepared, a, b, c))
        return std::nullopt;
    return t;
}

} // namespace vera
