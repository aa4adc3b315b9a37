// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/axial_ray.h"
#include "vera/scene/certified_crossings.h"
#include "vera/scene/primitives.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

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

    /// How far from the base it reaches, about.
    double reach() const {
        return std::max(std::max(from.r, to.r), std::max(std::abs(from.h), std::abs(to.h)));
    }

    bool reaches_height(double h) const {
        return h >= std::min(from.h, to.h) && h <= std::max(from.h, to.h);
    }
};

/// Whether a closed formula told all crossings with a piece, or came too near to an end of the
/// piece, or to a contact, for its rounding to be trusted.
enum class Verdict { settled, uncertain };

/// Far more than the rounding of the formulas, and yet seldom.
constexpr double uncertain_part = 0x1p-34;

inline bool
starts_on_ring(const PreparedRay& prepared, const RotationalShape& shape, const ContourLine& line) {
    const double height = dot(prepared.ray.origin - shape.base, shape.axis);
    return prepared.starts_at_origin()
        && std::abs(height - line.from.h) <= start_distance(prepared, shape, line.reach());
}

template <typename Sink>
inline Verdict for_each_ring_crossing(
    const PreparedRay& prepared,
    const RotationalShape& shape,
    const AxialRay& axial,
    const ContourLine& line,
    const Sink& sink) {
    if (axial.rise == 0)
        return Verdict::settled;
    // A ray almost in the ring's plane might be found to cross it and no other piece.
    if (axial.rise * axial.rise <= uncertain_part * uncertain_part * axial.a)
        return starts_on_ring(prepared, shape, line) ? Verdict::settled : Verdict::uncertain;
    const double s = (line.from.h - axial.height) / axial.rise;
    const double t = axial.t_reference + s;
    if (!prepared.covers(t))
        return Verdict::settled;
    const double radius_squared = axial.radius_squared_at(s);
    const double inner = std::min(line.from.r, line.to.r);
    const double outer = std::max(line.from.r, line.to.r);
    const double margin = uncertain_part * (outer * outer + axial.c);
    if (radius_squared < inner * inner - margin || radius_squared > outer * outer + margin)
        return Verdict::settled;
    if (starts_on_ring(prepared, shape, line))
        return Verdict::settled;
    const bool near_inner = inner > 0 && radius_squared < inner * inner + margin;
    if (near_inner || radius_squared > outer * outer - margin)
        return Verdict::uncertain;
    sink(t);
    return Verdict::settled;
}

/// The crossing of a ray that starts on a cone or cylinder with it, other than the start.
template <typename Sink>
inline void for_other_cone_crossing(
    const PreparedRay& prepared,
    const RotationalShape& shape,
    const AxialRay& axial,
    const ContourLine& line,
    const Sink& sink) {
    const Vec3 from_base = prepared.ray.origin - shape.base;
    const double height = dot(from_base, shape.axis);
    const Vec3 from_axis = from_base - height * shape.axis;
    const double k = axial.rise * line.slope();
    // One root of the quadratic equation is t = 0: what is left of it is linear.
    const double t =
        -2 * (dot(from_axis, axial.across) - line.radius_at(height) * k) / (axial.a - k * k);
    if (t > 0 && prepared.covers(t) && line.reaches_height(height + t * axial.rise))
        sink(t);
}

inline bool
starts_on_cone(const PreparedRay& prepared, const RotationalShape& shape, const ContourLine& line) {
    const Vec3 from_base = prepared.ray.origin - shape.base;
    const double height = dot(from_base, shape.axis);
    const double radius = length(from_base - height * shape.axis);
    const double slope = line.slope();
    return std::abs(radius - line.radius_at(height))
        <= start_distance(prepared, shape, line.reach()) * std::sqrt(1 + slope * slope);
}

template <typename Sink>
inline Verdict for_each_cone_crossing(
    const PreparedRay& prepared,
    const RotationalShape& shape,
    const AxialRay& axial,
    const ContourLine& line,
    bool starts_here,
    const Sink& sink) {
    if (starts_here) {
        for_other_cone_crossing(prepared, shape, axial, line, sink);
        return Verdict::settled;
    }
    // Where the radius of the ray and that of the cone, p + k s, are equal:
    // (a - k^2) s^2 + 2 (b - p k) s + (c - p^2) = 0.
    const double k = axial.rise * line.slope();
    const double p = line.radius_at(axial.height);
    // The discriminant as a difference of squares of lengths, in which less cancels.
    const Vec3 sum = p * axial.across - k * axial.from_axis;
    const Vec3 area = cross(axial.from_axis, axial.across);
    const double discriminant = dot(sum, sum) - (axial.flat ? axial.a * axial.c : dot(area, area));
    // Of a ray through the tip both lengths are 0.
    const double margin_of_contact = uncertain_part * (p * p * axial.a + k * k * axial.c);
    if (!(discriminant >= -margin_of_contact))
        return Verdict::settled;
    if (prepared.starts_at_origin() && starts_on_cone(prepared, shape, line)) {
        for_other_cone_crossing(prepared, shape, axial, line, sink);
        return Verdict::settled;
    }
    if (discriminant < margin_of_contact)
        return Verdict::uncertain;

    const double half = axial.b - p * k;
    const double root = std::sqrt(discriminant);
    const double larger = half > 0 ? -half - root : root - half;
    const double radius = std::sqrt(axial.c);
    const std::array<double, 2> both = {
        larger / (axial.a - k * k), (radius - p) * (radius + p) / larger};
    const double margin = uncertain_part * (line.reach() + std::abs(axial.height));
    for (const double s : both) {
        const double h = axial.height_at(s);
        if (std::abs(h - line.from.h) <= margin || std::abs(h - line.to.h) <= margin)
            return Verdict::uncertain;
    }
    for (const double s : both)
        if (prepared.covers(axial.t_reference + s) && line.reaches_height(axial.height_at(s)))
            sink(axial.t_reference + s);
    return Verdict::settled;
}

/// Whether the ray comes near the ring-shaped block that holds the curved piece, in its range: the
/// piece lies between its control points. Few rays do, and the search is only for those.
inline bool may_meet_curve(
    const PreparedRay& prepared,
    const AxialRay& axial,
    const ContourPiece& contour,
    ContourPiece::Point from) {
    double least_r = std::min(from.r, contour.end.r);
    double most_r = std::max(from.r, contour.end.r);
    double least_h = std::min(from.h, contour.end.h);
    double most_h = std::max(from.h, contour.end.h);
    const std::size_t controls = contour.kind == ContourPiece::Kind::cubic ? 2 : 1;
    for (std::size_t i = 0; i < controls; ++i) {
        least_r = std::min(least_r, contour.control[i].r);
        most_r = std::max(most_r, contour.control[i].r);
        least_h = std::min(least_h, contour.control[i].h);
        most_h = std::max(most_h, contour.control[i].h);
    }
    const double size = most_r + std::abs(least_h) + std::abs(most_h) + std::abs(axial.height);
    const double margin = uncertain_part * size;

    // The part of the ray, first <= s <= last, at these heights.
    double first = -std::numeric_limits<double>::infinity();
    double last = -first;
    if (axial.rise != 0) {
        const double at_least = (least_h - margin - axial.height) / axial.rise;
        const double at_most = (most_h + margin - axial.height) / axial.rise;
        first = std::min(at_least, at_most);
        last = std::max(at_least, at_most);
    } else if (axial.height < least_h - margin || axial.height > most_h + margin) {
        return false;
    }
    const double first_t = axial.t_reference + first;
    const double last_t = axial.t_reference + last;
    const auto margin_of = [&](double t, double s) {
        return uncertain_part * (std::abs(t) + std::abs(s) + std::abs(axial.t_reference));
    };
    if (first_t - margin_of(first_t, first) > prepared.ray.t_max
        || last_t + margin_of(last_t, last) < prepared.ray.t_min)
        return false;
    if (axial.a == 0)
        return true;

    // The ray's distance from the axis there, squared, and where it is least.
    const double nearest = std::clamp(-axial.b / axial.a, first, last);
    const double margin_squared =
        uncertain_part * (axial.c + axial.a * nearest * nearest + most_r * most_r);
    if (axial.radius_squared_at(nearest) > (most_r + margin) * (most_r + margin) + margin_squared)
        return false;
    const double farthest = std::max(axial.radius_squared_at(first), axial.radius_squared_at(last));
    const double hole = least_r - margin;
    return !(hole > 0 && farthest * (1 + uncertain_part) < hole * hole - uncertain_part * axial.c);
}

template <typename Sink>
inline void
sink_covered(const PreparedRay& prepared, const PieceCrossings& found, const Sink& sink) {
    for (std::size_t i = 0; i < found.count; ++i)
        if (prepared.covers(found.t[i]))
            sink(found.t[i]);
}

} // namespace detail

/// Whether a ray that starts on a shape of one straight piece, a cone or cylinder, leaves it for
/// good. Where it is not sure the answer is no.
inline bool leaves_single_cone(const PreparedRay& prepared, const RotationalShape& shape) {
    const detail::ContourLine line{shape.start, shape.contour.front().end};
    if (shape.contour.front().kind != ContourPiece::Kind::line || line.is_ring())
        return false;
    // In the arithmetic of for_other_cone_crossing, of which these are the signs.
    const Vec3 from_base = prepared.ray.origin - shape.base;
    const double height = dot(from_base, shape.axis);
    const Vec3 from_axis = from_base - height * shape.axis;
    const double rise = dot(prepared.ray.direction, shape.axis);
    const Vec3 across = prepared.ray.direction - rise * shape.axis;
    const double k = rise * line.slope();
    return dot(from_axis, across) - line.radius_at(height) * k >= 0 && dot(across, across) > k * k;
}

/// Calls sink(t, piece) for every crossing, in the ray's range, with the shape. Of the piece that
/// the ray starts on, by the caller's word or to within rounding, the crossing there is left out.
template <typename Sink>
inline void for_each_rotational_crossing(
    const PreparedRay& prepared,
    const RotationalShape& shape,
    std::uint32_t start_piece,
    const Sink& sink) {
    if (start_piece == 0 && shape.contour.size() == 1 && leaves_single_cone(prepared, shape))
        return;
    const AxialRay axial(prepared, shape);
    ContourPiece::Point from = shape.start;
    for (std::size_t i = 0; i < shape.contour.size(); ++i) {
        const auto piece = static_cast<std::uint32_t>(i);
        const bool starts_here = piece == start_piece;
        const ContourPiece& contour = shape.contour[i];
        const detail::ContourLine line{from, contour.end};
        const auto sink_piece = [&](double t) { sink(t, piece); };
        if (contour.kind != ContourPiece::Kind::line) {
            if (detail::may_meet_curve(prepared, axial, contour, from))
                detail::sink_covered(
                    prepared,
                    crossings_beyond_start(prepared, axial, shape, i, starts_here),
                    sink_piece);
        } else if (!(line.is_ring() && starts_here)) {
            const detail::Verdict verdict = line.is_ring()
                ? detail::for_each_ring_crossing(prepared, shape, axial, line, sink_piece)
                : detail::for_each_cone_crossing(
                    prepared, shape, axial, line, starts_here, sink_piece);
            if (verdict == detail::Verdict::uncertain)
                detail::sink_covered(
                    prepared, certified_crossings(axial, contour, from), sink_piece);
        }
        from = contour.end;
    }
}

} // namespace vera
