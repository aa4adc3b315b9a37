// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/check.h"
#include "vera/math/ray.h"
#include "vera/scene/geometry.h"
#include "vera/scene/hit.h"
#include "vera/scene/outline_table.h"
#include "vera/scene/polygon_crossing.h"
#include "vera/scene/prepared_ray.h"
#include "vera/scene/rotational_crossing.h"
#include "vera/scene/sphere_crossing.h"
#include "vera/scene/triangle_crossing.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

namespace vera {

/// How large the coordinates of a ray's origin are, in units of its t.
inline double coincidence_reach(const Ray& ray) {
    const double direction_size = max_component(abs(ray.direction));
    const double origin_size = max_component(abs(ray.origin)) + ray.origin_error;
    return direction_size > 0 ? origin_size / direction_size
                              : -std::numeric_limits<double>::infinity();
}

/// Hits of one ray whose t differ by no more than this, at t, are hits of surfaces that coincide:
/// the one that stands first in the text is in front. It follows from the rounding of coordinates
/// of the size of those where the ray passes, and scales with the scene.
inline double coincidence_tolerance(double reach, double t) {
    // Rounding moves t by a few units of 2^-53 of the coordinates over the cosine of incidence;
    // 2^-41 allows for cosines down to 1/500.
    return reach >= 0 ? 0x1p-41 * (reach + std::abs(t)) : 0;
}

inline double coincidence_tolerance(const Ray& ray, double t) {
    return coincidence_tolerance(coincidence_reach(ray), t);
}

inline std::array<Vec3, 3> corners_of(const Mesh& mesh, std::uint32_t triangle) {
    const std::size_t first = 3 * std::size_t{triangle};
    return {
        mesh.positions[mesh.position_indices[first]],
        mesh.positions[mesh.position_indices[first + 1]],
        mesh.positions[mesh.position_indices[first + 2]]};
}

inline std::span<const Vec3> corners_of(const Geometry& geometry, const Polygon& polygon) {
    return {geometry.corners.data() + polygon.first_corner, polygon.corner_count};
}

/// The corners of piece 0 or 1 of a split quadrangle.
inline std::array<Vec3, 3> corners_of_half(std::span<const Vec3> quadrangle, std::uint32_t piece) {
    return {quadrangle[0], quadrangle[piece + 1], quadrangle[piece + 2]};
}

namespace detail {

template <typename Sink>
void for_each_polygon_crossing(
    const Geometry& geometry,
    const Polygon& polygon,
    const PreparedRay& prepared,
    std::uint32_t start_piece,
    const Sink& sink) {
    const std::span<const Vec3> corners = corners_of(geometry, polygon);
    if (polygon.shape != Polygon::Shape::split_quadrangle) {
        if (start_piece == no_piece)
            if (const auto t = polygon_crossing(prepared, corners, polygon.normal))
                sink(*t, 0U);
        return;
    }
    for (std::uint32_t piece = 0; piece < 2; ++piece) {
        if (piece == start_piece)
            continue;
        const auto half = corners_of_half(corners, piece);
        if (const auto t = triangle_crossing(prepared, half[0], half[1], half[2]))
            sink(*t, piece);
    }
}

} // namespace detail

/// Calls sink(t, piece) for every crossing of the ray with the element, t_min <= t <= t_max, in no
/// certain order. start_piece is the piece of this very element that the ray starts on, or
/// no_piece: where the ray starts is not a crossing, and a plane face has no other. The same holds
/// of surfaces that pass through the ray's origin to within rounding. The element must not be a
/// subscene call.
template <typename Sink>
void for_each_crossing(
    const Geometry& geometry,
    Element element,
    const PreparedRay& prepared,
    std::uint32_t start_piece,
    Sink&& sink) {
    const Item& item = geometry.items[element.item];
    const auto sink_triangle = [&](const std::array<Vec3, 3>& corners) {
        if (start_piece == no_piece)
            if (const auto t = triangle_crossing(prepared, corners[0], corners[1], corners[2]))
                sink(*t, std::uint32_t{0});
    };
    switch (item.kind) {
    case ItemKind::sphere:
        for_each_sphere_crossing(
            prepared, geometry.spheres[item.index], start_piece != no_piece, [&](double t) {
                sink(t, std::uint32_t{0});
            });
        return;
    case ItemKind::triangle:
        sink_triangle(geometry.triangles[item.index].corners);
        return;
    case ItemKind::patch:
        sink_triangle(geometry.patches[item.index].corners);
        return;
    case ItemKind::mesh:
        sink_triangle(corners_of(geometry.meshes[item.index], element.triangle));
        return;
    case ItemKind::polygon:
        detail::for_each_polygon_crossing(
            geometry, geometry.polygons[item.index], prepared, start_piece, sink);
        return;
    case ItemKind::rotational_shape:
        for_each_rotational_crossing(
            prepared, geometry.rotational_shapes[item.index], start_piece, sink);
        return;
    case ItemKind::subscene_call:
        break;
    }
    VERA_CHECK(item.kind != ItemKind::subscene_call);
}

/// The same by the geometry's table of outlines, to the bit, and faster.
template <typename Sink>
void for_each_crossing(
    const Geometry& geometry,
    const OutlineTable& outlines,
    Element element,
    const PreparedRay& prepared,
    std::uint32_t start_piece,
    Sink&& sink) {
    const Item& item = geometry.items[element.item];
    const OutlineStrips* outline =
        item.kind == ItemKind::polygon ? outlines.of_polygon(item.index) : nullptr;
    if (outline == nullptr)
        return for_each_crossing(geometry, element, prepared, start_piece, sink);
    if (start_piece != no_piece)
        return;
    const Polygon& polygon = geometry.polygons[item.index];
    if (const auto t = polygon_crossing(
            prepared, corners_of(geometry, polygon), polygon.normal, outlines, *outline))
        sink(*t, std::uint32_t{0});
}

template <typename Sink>
void for_each_crossing(
    const Geometry& geometry,
    Element element,
    const Ray& ray,
    std::uint32_t start_piece,
    Sink&& sink) {
    for_each_crossing(geometry, element, PreparedRay(ray), start_piece, sink);
}

} // namespace vera
