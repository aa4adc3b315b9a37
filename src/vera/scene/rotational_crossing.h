// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/axial_ray.h"
#include "vera/scene/hit.h"
#include "vera/scene/primitives.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vera {

namespace detail {

/// A straight piece of a contour. Two points with the same h make a plane ring, others a cylinder
/// or a cone.
struct ContourLine {
    ContourPiece::Point from;
    ContourPiece::Point to;

    bool is_ring() const { return from.h == to.h; }

    double slope() const { return (to.r - from.r) / (to.h - from.h); }

    double radius_at(double h) const { return from.r + (h - from.h) * slope(); }

    bool reaches_height(double h) const {
        return h >= std::min(from.h, to.h) && h <= std::max(from.h, to.h);
    }
};

inline double
start_distance(const PreparedRay& prepared, const RotationalShape& shape, const ContourLine& line) {
    const double reach = std::max(
        std::max(line.from.r, line.to.r), std::max(std::abs(line.from.h), std::abs(line.to.h)));
    // sqrt(3) times the error along each axis, which the axis' direction has too.
    return 1.75 * prepared.start_distance(max_component(abs(shape.base)) + reach);
}

template <typename Sink>
inline void for_each_ring_crossing(
    const PreparedRay& prepared,
    const RotationalShape& shape,
    const AxialRay& axial,
    const ContourLine& line,
    const Sink& sink) {
    if (axial.rise == 0)
        return;
    const double s = (line.from.h - axial.height) / axial.rise;
    const double t = axial.t_reference + s;
    if (!prepared.covers(t))
        return;
    const double radius_squared = axial.radius_squared_at(s);
    const double inner = std::min(line.from.r, line.to.r);
    const double outer = std::max(line.from.r, line.to.r);
    if (!(radius_squared >= inner * inner && radius_squared <= outer * outer))
        return;
    if (prepared.starts_at_origin()) {
        const double origin_height = dot(prepared.ray.origin - shape.base, shape.axis);
        if (std::abs(origin_height - line.from.h) <= start_distance(prepared, shape, line))
            return;
    }
    sink(t);
}

template <typename Sink>
inline void for_each_cone_crossing(
    const PreparedRay& prepared,
    const RotationalShape& shape,
    const AxialRay& axial,
    const ContourLine& line,
    bool starts_here,
    const Sink& sink) {
    // Where the radius of the ray and that of the cone, p + k s, are equal:
    // (a - k^2) s^2 + 2 (b - p k) s + (c - p^2) = 0.
    const double slope = line.slope();
    const double k = axial.rise * slope;
    const double p = line.radius_at(axial.height);
    const double leading = axial.a - k * k;

    const Vec3 from_base = prepared.ray.origin - shape.base;
    const double origin_height = dot(from_base, shape.axis);
    const Vec3 from_axis = from_base - origin_height * shape.axis;
    const double origin_radius = line.radius_at(origin_height);
    if (!starts_here && prepared.starts_at_origin()) {
        const double off = std::abs(length(from_axis) - origin_radius);
        starts_here = off <= start_distance(prepared, shape, line) * std::sqrt(1 + slope * slope);
    }
    if (starts_here) {
        // One root is t = 0: what is left of the equation is linear.
        const double t = -2 * (dot(from_axis, axial.across) - origin_radius * k) / leading;
        if (t > 0 && prepared.covers(t) && line.reaches_height(origin_height + t * axial.rise))
            sink(t);
        return;
    }

    // The discriminant as a difference of squares of lengths, in which less cancels.
    const Vec3 sum = p * axial.across - k * axial.from_axis;
    const double nearest = axial.flat
        ? axial.a * axial.c
        : dot(cross(axial.from_axis, axial.across), cross(axial.from_axis, axial.across));
    const double discriminant = dot(sum, sum) - nearest;
    if (!(discriminant >= 0))
        return;
    const double half = axial.b - p * k;
    const double root = std::sqrt(discriminant);
    const double larger = half > 0 ? -half - root : root - half;
    const double radius = std::sqrt(axial.c);
    const double constant = (radius - p) * (radius + p);
    const double first = larger / leading;
    const double second = constant / larger;
    for (const double s : {std::min(first, second), std::max(first, second)})
        if (prepared.covers(axial.t_reference + s) && line.reaches_height(axial.height_at(s)))
            sink(axial.t_reference + s);
}

} // namespace detail

/// Calls sink(t, piece) for every crossing, in the ray's range, with the shape. Of the piece that
/// the ray starts on, by the caller's word or to within rounding, the crossing there is left out.
template <typename Sink>
inline void for_each_rotational_crossing(
    const PreparedRay& prepared,
    const RotationalShape& shape,
    std::uint32_t start_piece,
    const Sink& sink) {
    const AxialRay axial(prepared, shape);
    ContourPiece::Point from = shape.start;
    for (std::size_t i = 0; i < shape.contour.size(); ++i) {
        const auto piece = static_cast<std::uint32_t>(i);
        const detail::ContourLine line{from, shape.contour[i].end};
        const auto sink_piece = [&](double t) { sink(t, piece); };
        if (!line.is_ring())
            detail::for_each_cone_crossing(
                prepared, shape, axial, line, piece == start_piece, sink_piece);
        else if (piece != start_piece)
            detail::for_each_ring_crossing(prepared, shape, axial, line, sink_piece);
        from = shape.contour[i].end;
    }
}

} // namespace vera
