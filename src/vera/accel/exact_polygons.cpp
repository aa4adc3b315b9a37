// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/exact_polygons.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vera/accel/exact_polygons.cpp"
#include <hwy/foreach_target.h>
// Behind the line above, which includes this file once for each instruction set.
#include "vera/accel/exact_lanes-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE Vec all(double value) {
    return hn::Set(Doubles(), value);
}

/// std::min(), and std::max(), also where a number is none.
HWY_INLINE Vec lesser(Vec a, Vec b) {
    return hn::IfThenElse(hn::Lt(b, a), b, a);
}

HWY_INLINE Vec greater(Vec a, Vec b) {
    return hn::IfThenElse(hn::Lt(a, b), b, a);
}

/// Zero, or of a size from least to most.
HWY_INLINE Mask is_ordinary(Vec number, double least, double most) {
    const Vec size = hn::Abs(number);
    return hn::Or(
        hn::Eq(size, hn::Zero(Doubles())),
        hn::And(hn::Ge(size, all(least)), hn::Le(size, all(most))));
}

/// A part of the packet's rays, and where they meet the planes of polygons.
struct PlanePart {
    Vec origin[3];
    Vec direction[3];
    Mask along_x; ///< the ray's longest axis
    Mask along_y;
    Vec speed;
    Vec distance;
    Vec by_plane;
};

HWY_INLINE void fill_plane_part(
    const Frame& frame,
    std::size_t lane,
    const Vec (&corner)[3],
    const Vec (&normal)[3],
    PlanePart& part) {
    Vec to_corner[3] = {corner[0], corner[1], corner[2]};
    for (std::size_t i = 0; i < 3; ++i) {
        part.origin[i] = row(frame.rays.origin[i], lane);
        part.direction[i] = row(frame.rays.direction[i], lane);
        to_corner[i] = hn::Sub(corner[i], part.origin[i]);
    }
    const Vec axis = row(frame.prepared_rows.axis, lane);
    part.along_x = hn::Eq(axis, hn::Zero(Doubles()));
    part.along_y = hn::Eq(axis, all(1));
    part.speed = dot3(normal, part.direction);
    part.distance = dot3(normal, to_corner);
    part.by_plane = hn::Div(part.distance, part.speed);
}

/// range_between() and plane_crossing(): fills in t; returns the rays that cross the plane where
/// and how it counts. lowest and highest are those of the corners along the rays' longest axes,
/// from their origins.
HWY_INLINE Mask cross_plane(
    const Frame& frame,
    std::size_t lane,
    const PlanePart& part,
    Vec lowest,
    Vec highest,
    Vec corner_size,
    Vec normal_size,
    Vec& t) {
    const PreparedRows& prepared = frame.prepared_rows;
    const Vec direction_z = row(prepared.direction_z, lane);
    const Vec t_of_lowest = hn::Div(lowest, direction_z);
    const Vec t_of_highest = hn::Div(highest, direction_z);
    const Vec first = lesser(t_of_lowest, t_of_highest);
    const Vec last = greater(t_of_lowest, t_of_highest);
    t = hn::IfThenElse(
        hn::Lt(part.by_plane, first),
        first,
        hn::IfThenElse(hn::Gt(part.by_plane, last), last, part.by_plane));
    const Vec start_distance = hn::Add(
        row(frame.rays.origin_error, lane),
        hn::Mul(all(0x1p-48), greater(row(prepared.origin_size, lane), corner_size)));
    const Mask starts = hn::And(
        hn::Ge(row(frame.rays.t_min, lane), hn::Zero(Doubles())),
        hn::Le(hn::Abs(part.distance), hn::Mul(start_distance, normal_size)));
    const Mask none = hn::Or(starts, hn::Eq(part.speed, hn::Zero(Doubles())));
    return hn::AndNot(none, covers(frame, lane, t));
}

/// The number of one of count strips or cells.
HWY_INLINE Vec number_at(Vec place, double lower, double per_unit, std::uint32_t count) {
    const Vec number = hn::Mul(hn::Sub(place, all(lower)), all(per_unit));
    return hn::Trunc(hn::Min(hn::Max(number, hn::Zero(Doubles())), all(count - 1.0)));
}

/// What is constant for a polygon, axis by axis.
struct SeenPolygon {
    double corner[3];
    double normal[3];
    double corner_size;
    double normal_size; ///< the sum of the components
    std::size_t u_axis;
    std::size_t v_axis;
};

/// The lanes of a vector that pass a polygon within its bounds, and where.
struct CellRows {
    LaneMask in_cell = 0; ///< those that lie in one strip, and there with their margins in one cell
    RayRows::Row strip;
    RayRows::Row cell;
};

/// The operations of polygon_crossing() and inclusion_status() up to where these ask for cells, in
/// their order: see there for what is sure.
HWY_INLINE void cross_part(
    const Frame& frame,
    const SeenPolygon& polygon,
    const OutlineStrips& outline,
    std::size_t lane,
    CellRows& rows,
    PolygonCrossings& crossings) {
    const PreparedRows& prepared = frame.prepared_rows;
    const Vec corner[3] = {all(polygon.corner[0]), all(polygon.corner[1]), all(polygon.corner[2])};
    const Vec normal[3] = {all(polygon.normal[0]), all(polygon.normal[1]), all(polygon.normal[2])};
    PlanePart part;
    fill_plane_part(frame, lane, corner, normal, part);
    // range_of_corners()
    const auto along = [&](const Vec3& bound) HWY_ATTR {
        return hn::Sub(
            chosen(part.along_x, all(bound.x), part.along_y, all(bound.y), all(bound.z)),
            chosen(part.along_x, part.origin[0], part.along_y, part.origin[1], part.origin[2]));
    };
    Vec t = hn::Zero(Doubles());
    const Mask passes = cross_plane(
        frame,
        lane,
        part,
        along(outline.bounds.lower),
        along(outline.bounds.upper),
        all(polygon.corner_size),
        all(polygon.normal_size),
        t);
    store(t, crossings.t, lane);

    // inclusion_status()
    const Vec direction_size = hn::Abs(row(prepared.direction_z, lane));
    const Vec speed_size = hn::Abs(part.speed);
    const Vec size = hn::Add(
        hn::Add(all(outline.size), row(prepared.origin_size, lane)),
        hn::Mul(hn::Abs(part.by_plane), direction_size));
    Mask known = hn::And(
        hn::Le(size, all(0x1p202)), hn::Ge(speed_size, hn::Mul(all(0x1p-30), direction_size)));
    for (std::size_t i = 0; i < 3; ++i)
        known = hn::And(known, is_ordinary(part.origin[i], 0x1p-200, 0x1p200));
    known = hn::And(known, is_ordinary(direction_size, 0x1p-200, 0x1p200));
    known = hn::And(known, is_ordinary(row(prepared.shear_x, lane), 0x1p-100, 1));
    known = hn::And(known, is_ordinary(row(prepared.shear_y, lane), 0x1p-100, 1));
    const Vec noise = hn::Mul(all(0x1p-46), size);
    const Vec slant = hn::Div(hn::Add(all(outline.deviation), noise), speed_size);
    const auto lowest_of = [&](std::size_t of_axis) HWY_ATTR {
        const Vec place =
            hn::Add(part.origin[of_axis], hn::Mul(part.by_plane, part.direction[of_axis]));
        return hn::Sub(place, hn::Add(noise, hn::Mul(slant, hn::Abs(part.direction[of_axis]))));
    };
    const auto highest_of = [&](std::size_t of_axis) HWY_ATTR {
        const Vec place =
            hn::Add(part.origin[of_axis], hn::Mul(part.by_plane, part.direction[of_axis]));
        return hn::Add(place, hn::Add(noise, hn::Mul(slant, hn::Abs(part.direction[of_axis]))));
    };
    const double lower_u = outline.bounds.lower.*outline.u_axis;
    const double lower_v = outline.bounds.lower.*outline.v_axis;
    const Vec u_from = lowest_of(polygon.u_axis);
    const Vec u_to = highest_of(polygon.u_axis);
    const Vec v_from = lowest_of(polygon.v_axis);
    const Vec v_to = highest_of(polygon.v_axis);
    const Mask outside = hn::Or(
        hn::Or(
            hn::Lt(u_to, all(lower_u)), hn::Gt(u_from, all(outline.bounds.upper.*outline.u_axis))),
        hn::Or(
            hn::Lt(v_to, all(lower_v)), hn::Gt(v_from, all(outline.bounds.upper.*outline.v_axis))));
    const Vec strip = number_at(v_from, lower_v, outline.strips_per_unit, outline.strip_count);
    const Vec last_strip = number_at(v_to, lower_v, outline.strips_per_unit, outline.strip_count);
    const Vec cell = number_at(u_from, lower_u, outline.cells_per_unit, StripCells::count);
    const Vec last_cell = number_at(u_to, lower_u, outline.cells_per_unit, StripCells::count);
    store(strip, rows.strip, lane);
    store(cell, rows.cell, lane);
    const Mask may = hn::AndNot(hn::And(known, outside), passes);
    const Mask in_cell =
        hn::And(hn::And(may, known), hn::And(hn::Eq(strip, last_strip), hn::Eq(cell, last_cell)));
    rows.in_cell |= bits(in_cell, lane);
    crossings.undecided |= bits(hn::AndNot(in_cell, may), lane);
}

void cross_polygon_kernel(
    const Frame& frame,
    LaneMask lanes,
    const Vec3& corner,
    const Vec3& normal,
    const OutlineTable& table,
    const OutlineStrips& outline,
    PolygonCrossings& crossings) {
    const auto axis_number = [](double Vec3::*axis) {
        return axis == &Vec3::x ? std::size_t{0}
            : axis == &Vec3::y  ? std::size_t{1}
                                : std::size_t{2};
    };
    const SeenPolygon polygon = {
        {corner.x, corner.y, corner.z},
        {normal.x, normal.y, normal.z},
        max_component(abs(corner)),
        std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z),
        axis_number(outline.u_axis),
        axis_number(outline.v_axis)};
    crossings.met = crossings.undecided = 0;
    CellRows rows;
    for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(Doubles()))
        if (any_in_vector(lanes, lane))
            cross_part(frame, polygon, outline, lane, rows, crossings);
    crossings.undecided &= lanes;
    for (LaneMask rest = rows.in_cell & lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        const auto strip = static_cast<std::size_t>(rows.strip[lane]);
        const auto cell = static_cast<std::uint32_t>(rows.cell[lane]);
        const StripCells& cells = table.cells[outline.first_strip + strip];
        crossings.met |= static_cast<LaneMask>((cells.known & cells.inside) >> cell & 1U) << lane;
        crossings.undecided |= static_cast<LaneMask>(~cells.known >> cell & 1U) << lane;
    }
}

/// meets_outline() of each lane's four corners as its ray sees them.
HWY_INLINE Mask meets_quadrangle(const Vec (&x)[4], const Vec (&y)[4]) {
    const Vec zero = hn::Zero(Doubles());
    Mask on_boundary = hn::And(hn::Eq(x[0], zero), hn::Eq(y[0], zero));
    Vec turns = zero;
    for (std::size_t to = 0; to < 4; ++to) {
        const std::size_t from = to == 0 ? 3 : to - 1;
        const Mask from_below = hn::Le(y[from], zero);
        const Mask crosses = hn::Xor(from_below, hn::Le(y[to], zero));
        const Vec side = hn::Sub(hn::Mul(x[from], y[to]), hn::Mul(y[from], x[to]));
        const Mask upwards = hn::And(from_below, hn::Gt(side, zero));
        const Mask downwards = hn::AndNot(from_below, hn::Lt(side, zero));
        turns = hn::Add(turns, hn::IfThenElseZero(hn::And(crosses, upwards), all(1)));
        turns = hn::Sub(turns, hn::IfThenElseZero(hn::And(crosses, downwards), all(1)));
        const Mask level = hn::And(hn::Eq(y[from], zero), hn::Eq(y[to], zero));
        const Mask about = hn::Or(
            hn::And(hn::Le(x[from], zero), hn::Ge(x[to], zero)),
            hn::And(hn::Ge(x[from], zero), hn::Le(x[to], zero)));
        const Mask at_corner = hn::And(hn::Eq(x[to], zero), hn::Eq(y[to], zero));
        on_boundary = hn::Or(on_boundary, hn::And(crosses, hn::Eq(side, zero)));
        on_boundary = hn::Or(on_boundary, hn::Or(hn::And(level, about), at_corner));
    }
    return hn::Or(on_boundary, hn::Ne(turns, zero));
}

/// The operations of polygon_crossing(), in their order.
HWY_INLINE LaneMask cross_quadrangle_part(
    const Frame& frame, const QuadrangleRows& quadrangles, std::size_t lane, RayRows::Row& ts) {
    const PreparedRows& prepared = frame.prepared_rows;
    const Vec zero = hn::Zero(Doubles());
    const auto corner_of = [&](std::size_t corner, std::size_t axis)
                               HWY_ATTR { return row(quadrangles.corners[corner][axis], lane); };
    const Vec corner[3] = {corner_of(0, 0), corner_of(0, 1), corner_of(0, 2)};
    const Vec normal[3] = {
        row(quadrangles.normal[0], lane),
        row(quadrangles.normal[1], lane),
        row(quadrangles.normal[2], lane)};
    PlanePart part;
    fill_plane_part(frame, lane, corner, normal, part);
    const Vec shear_x = row(prepared.shear_x, lane);
    const Vec shear_y = row(prepared.shear_y, lane);
    Vec x[4] = {zero, zero, zero, zero};
    Vec y[4] = {zero, zero, zero, zero};
    Vec lowest = all(std::numeric_limits<double>::infinity());
    Vec highest = hn::Neg(lowest);
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec from[3] = {
            hn::Sub(corner_of(i, 0), part.origin[0]),
            hn::Sub(corner_of(i, 1), part.origin[1]),
            hn::Sub(corner_of(i, 2), part.origin[2])};
        // sheared()
        const Vec z = chosen(part.along_x, from[0], part.along_y, from[1], from[2]);
        x[i] = hn::Sub(
            chosen(part.along_x, from[1], part.along_y, from[2], from[0]), hn::Mul(shear_x, z));
        y[i] = hn::Sub(
            chosen(part.along_x, from[2], part.along_y, from[0], from[1]), hn::Mul(shear_y, z));
        lowest = lesser(lowest, z);
        highest = greater(highest, z);
    }
    Vec t = zero;
    const Mask passes = cross_plane(
        frame,
        lane,
        part,
        lowest,
        highest,
        largest3(corner),
        sum3(hn::Abs(normal[0]), hn::Abs(normal[1]), hn::Abs(normal[2])),
        t);
    store(t, ts, lane);
    return bits(hn::And(passes, meets_quadrangle(x, y)), lane);
}

LaneMask cross_quadrangles_kernel(
    const Frame& frame, LaneMask lanes, const QuadrangleRows& quadrangles, RayRows::Row& t) {
    LaneMask met = 0;
    for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(Doubles()))
        if (any_in_vector(lanes, lane))
            met |= cross_quadrangle_part(frame, quadrangles, lane, t);
    return met & lanes;
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vera::detail {

HWY_EXPORT(cross_polygon_kernel);
HWY_EXPORT(cross_quadrangles_kernel);

void cross_polygon(
    const Frame& frame,
    LaneMask lanes,
    const Vec3& first_corner,
    const Vec3& normal,
    const OutlineTable& table,
    const OutlineStrips& outline,
    PolygonCrossings& crossings) {
    HWY_DYNAMIC_DISPATCH(cross_polygon_kernel)
    (frame, lanes, first_corner, normal, table, outline, crossings);
}

LaneMask cross_quadrangles(
    const Frame& frame, LaneMask lanes, const QuadrangleRows& quadrangles, RayRows::Row& t) {
    return HWY_DYNAMIC_DISPATCH(cross_quadrangles_kernel)(frame, lanes, quadrangles, t);
}

} // namespace vera::detail

#endif
