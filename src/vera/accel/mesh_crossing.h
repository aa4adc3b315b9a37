// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/float_tree.h"
#include "vera/accel/mesh_index.h"
#include "vera/math/vec3.h"
#include "vera/scene/prepared_ray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace vera::detail {

/// A crossing as it is decided: before it is rounded to a MeshHit.
struct MeshCrossing {
    double t = 0;
    double u = 0;
    double v = 0;
};

/// Where the ray's line crosses a triangle's plane, in the order of operations that every way of
/// answering follows. Not finite where the line lies in the plane.
inline MeshCrossing plane_crossing(Vec3 origin, Vec3 direction, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 e = b - a;
    const Vec3 f = c - a;
    const Vec3 to_a = a - origin;
    const Vec3 normal = cross(e, f);
    const Vec3 moment = cross(to_a, direction);
    const double per_speed = 1 / dot(normal, direction);
    return {
        dot(normal, to_a) * per_speed, dot(moment, f) * per_speed, -(dot(moment, e) * per_speed)};
}

/// A ray as mesh_crossing() wants it.
inline PreparedRay prepared_mesh_ray(const MeshRay& ray) {
    constexpr float largest = std::numeric_limits<float>::max();
    return PreparedRay(
        {in_double(ray.origin),
         in_double(ray.direction),
         static_cast<double>(std::max(ray.t_min, -largest)),
         static_cast<double>(std::min(ray.t_max, largest))});
}

/// The last t at which the ray is within the triangle's bounds; nothing where it is not.
inline std::optional<double> end_in_bounds(const Ray& ray, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 lower = min(a, min(b, c)) - ray.origin;
    const Vec3 upper = max(a, max(b, c)) - ray.origin;
    // Sheared corners are rounded by a few units of 2^-53 of this.
    const double margin = 0x1p-48 * max_component(max(abs(lower), abs(upper)));
    double near = -std::numeric_limits<double>::infinity();
    double far = std::numeric_limits<double>::infinity();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double direction = ray.direction[axis];
        if (direction == 0) {
            if (lower[axis] > margin || upper[axis] < -margin)
                return std::nullopt;
            continue;
        }
        const double at_lower = (lower[axis] - margin) / direction;
        const double at_upper = (upper[axis] + margin) / direction;
        near = std::max(near, std::min(at_lower, at_upper));
        far = std::min(far, std::max(at_lower, at_upper));
    }
    if (near > far)
        return std::nullopt;
    return far;
}

/// A ray that comes to a triangle's plane faster than this, by the largest coordinates of its
/// direction and two sides, is well known to meet the plane where rounding says.
constexpr double well_known_crossing = 0x1p-20;

/// Whether it does.
inline bool is_well_known(Vec3 direction, Vec3 a, Vec3 b, Vec3 c) {
    const double size =
        max_component(abs(b - a)) * max_component(abs(c - a)) * max_component(abs(direction));
    return std::abs(dot(cross(b - a, c - a), direction)) > well_known_crossing * size;
}

/// The test that decides whether a ray meets a triangle, its edges and corners included, and where.
/// A ray in the triangle's plane does not.
///
/// On which side of its edges a ray passes is decided as in triangle_crossing(), watertight. Of
/// what is seen edge-on, or is tiny and far away, rounding may leave edge functions of one sign far
/// beside it: the ray must come to the triangle's bounds as well. t is where it meets the plane,
/// or, since that is badly known of rays that all but lie in it, where they leave the bounds.
inline std::optional<MeshCrossing>
mesh_crossing(const PreparedRay& prepared, Vec3 a, Vec3 b, Vec3 c) {
    const Ray& ray = prepared.ray;
    const MeshCrossing crossing = plane_crossing(ray.origin, ray.direction, a, b, c);
    const bool known = is_well_known(ray.direction, a, b, c);
    // Most of what is asked about is the face that a ray starts beside: this settles it.
    if (known && !prepared.covers(crossing.t))
        return std::nullopt;
    const ShearedPoint p = sheared(prepared, a);
    const ShearedPoint q = sheared(prepared, b);
    const ShearedPoint r = sheared(prepared, c);
    const double u = edge_function(q, r);
    const double v = edge_function(r, p);
    const double w = edge_function(p, q);
    if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)))
        return std::nullopt;
    const double area = u + v + w;
    if (area == 0)
        return std::nullopt;
    const std::optional<double> end = end_in_bounds(ray, a, b, c);
    if (!end)
        return std::nullopt;
    if (known)
        return crossing;
    if (!prepared.covers(*end))
        return std::nullopt;
    return MeshCrossing{*end, v / area, w / area};
}

/// The coordinates of a triangle's corners, one corner after the other.
using CornerNumbers = std::array<float, 9>;

inline CornerNumbers corner_numbers(const MeshSpans& mesh, std::uint32_t triangle) {
    const auto& corners = mesh.triangles[triangle];
    CornerNumbers numbers;
    for (std::size_t corner = 0; corner < 3; ++corner)
        for (std::size_t axis = 0; axis < 3; ++axis)
            numbers[3 * corner + axis] = mesh.vertices[corners[corner]][axis];
    return numbers;
}

inline std::optional<MeshCrossing>
crossing_with(const PreparedRay& prepared, const CornerNumbers& numbers) {
    return mesh_crossing(
        prepared,
        in_double({numbers[0], numbers[1], numbers[2]}),
        in_double({numbers[3], numbers[4], numbers[5]}),
        in_double({numbers[6], numbers[7], numbers[8]}));
}

/// What is told of a crossing: without -0.
inline MeshHit mesh_hit(const MeshCrossing& crossing, std::uint32_t triangle) {
    const auto part = [](double value) {
        return static_cast<float>(std::clamp(value, 0.0, 1.0) + 0.0);
    };
    return {static_cast<float>(crossing.t) + 0.0F, triangle, part(crossing.u), part(crossing.v)};
}

/// The crossings of one ray with triangles in any order, of which the nearest is wanted: of those
/// of one t, that of the triangle with the smallest number.
struct NearestCrossing {
    MeshCrossing crossing = {std::numeric_limits<double>::infinity(), 0, 0};
    std::uint32_t triangle = no_triangle;

    void add(const MeshCrossing& other, std::uint32_t number) {
        if (other.t < crossing.t || (other.t == crossing.t && number < triangle)) {
            crossing = other;
            triangle = number;
        }
    }

    MeshHit hit() const {
        return triangle == no_triangle ? MeshHit{} : mesh_hit(crossing, triangle);
    }
};

/// Decides in double precision which triangles of a mesh a ray meets, and which first of those that
/// are considered. The ray is followed: see is_followed().
class MeshDecider {
public:
    MeshDecider(const MeshSpans& mesh, const MeshRay& ray)
        : mesh_(mesh)
        , ray_(prepared_mesh_ray(ray)) {}

    /// Of a triangle with these corners.
    bool meets(const CornerNumbers& corners) const {
        return crossing_with(ray_, corners).has_value();
    }

    bool meets(std::uint32_t triangle) const { return meets(corner_numbers(mesh_, triangle)); }

    /// The triangle, whose corners the caller knows already.
    void consider(std::uint32_t triangle, const CornerNumbers& corners) {
        if (const auto crossing = crossing_with(ray_, corners))
            nearest_.add(*crossing, triangle);
    }

    void consider(std::uint32_t triangle) { consider(triangle, corner_numbers(mesh_, triangle)); }

    /// Of the nearest crossing so far; infinity where there is none.
    double t() const { return nearest_.crossing.t; }

    MeshHit hit() const { return nearest_.hit(); }

    /// Calls add(hit, t) for each crossing with the triangle.
    template <typename Add>
    void for_each_hit(std::uint32_t triangle, const Add& add) const {
        if (const auto crossing = crossing_with(ray_, corner_numbers(mesh_, triangle)))
            add(mesh_hit(*crossing, triangle), crossing->t);
    }

private:
    const MeshSpans& mesh_;
    PreparedRay ray_;
    NearestCrossing nearest_;
};

} // namespace vera::detail
