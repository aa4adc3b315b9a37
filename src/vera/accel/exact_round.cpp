// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/exact_round.h"

#include "vera/scene/rotational_crossing.h"

#include <cstdint>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vera/accel/exact_round.cpp"
#include <hwy/foreach_target.h>
// Behind the line above, which includes this file once for each instruction set.
#include "vera/accel/exact_lanes-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE Mask mask_of(LaneMask lanes, std::size_t lane) {
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(lanes >> lane)};
    return hn::LoadMaskBits(Doubles(), bytes);
}

HWY_INLINE void load3(const std::array<RayRows::Row, 3>& rows, std::size_t lane, Vec (&result)[3]) {
    for (std::size_t i = 0; i < 3; ++i)
        result[i] = row(rows[i], lane);
}

/// PreparedRay::start_distance()
HWY_INLINE Vec start_distance(const Frame& frame, std::size_t lane, Vec coordinate_size) {
    Vec origin[3];
    load3(frame.rays.origin, lane, origin);
    return hn::Add(
        row(frame.rays.origin_error, lane),
        hn::Mul(hn::Set(Doubles(), 0x1p-48), hn::Max(coordinate_size, largest3(origin))));
}

HWY_INLINE void
put(RoundCrossings& crossings, std::size_t which, Mask met, Vec t, std::size_t lane) {
    crossings.met[which] |= bits(met, lane);
    hn::Store(t, Doubles(), crossings.t[which].data() + lane);
}

/// The operations of for_each_sphere_crossing(), in their order.
HWY_INLINE void cross_part(
    const Frame& frame,
    const SphereRows& spheres,
    LaneMask starting,
    std::size_t lane,
    RoundCrossings& crossings) {
    const Doubles d;
    const Vec radius = row(spheres.radius, lane);
    Vec direction[3];
    load3(frame.rays.direction, lane, direction);
    Vec center[3];
    load3(spheres.center, lane, center);
    Vec to_center[3];
    for (std::size_t i = 0; i < 3; ++i)
        to_center[i] = hn::Sub(center[i], row(frame.rays.origin[i], lane));
    const Vec speed_squared = dot3(direction, direction);
    const Vec t_closest = hn::Div(dot3(to_center, direction), speed_squared);
    Vec offset[3];
    for (std::size_t i = 0; i < 3; ++i)
        offset[i] = hn::Sub(to_center[i], hn::Mul(t_closest, direction[i]));
    const Vec radius_squared = hn::Mul(radius, radius);
    const Vec half_chord_squared = hn::Sub(radius_squared, dot3(offset, offset));
    const Mask passes = hn::Ge(half_chord_squared, hn::Zero(d));

    // Those that start there have one other crossing.
    const Vec from_surface = hn::Abs(hn::Sub(dot3(to_center, to_center), radius_squared));
    const Vec near = hn::Mul(
        hn::Mul(hn::Add(radius, radius), hn::Set(d, 1.75)),
        start_distance(frame, lane, hn::Max(largest3(center), radius)));
    const Mask is_near =
        hn::And(hn::Ge(row(frame.rays.t_min, lane), hn::Zero(d)), hn::Le(from_surface, near));
    const Mask starts = hn::Or(mask_of(starting, lane), hn::And(passes, is_near));
    const Mask meets_twice = hn::AndNot(starts, passes);
    const Mask meets_other = hn::And(starts, hn::Gt(t_closest, hn::Zero(d)));

    const Vec half_chord = hn::Sqrt(hn::Div(half_chord_squared, speed_squared));
    const Vec first = hn::Sub(t_closest, half_chord);
    const Vec second =
        hn::IfThenElse(starts, hn::Add(t_closest, t_closest), hn::Add(t_closest, half_chord));
    put(crossings, 0, hn::And(meets_twice, covers(frame, lane, first)), first, lane);
    const Mask meets_second = hn::Or(meets_twice, meets_other);
    put(crossings, 1, hn::And(meets_second, covers(frame, lane, second)), second, lane);
}

/// ContourLine, for each lane.
struct Lines {
    Vec from_r;
    Vec from_h;
    Vec to_r;
    Vec to_h;
    Vec slope;

    HWY_INLINE Vec radius_at(Vec h) const {
        return hn::Add(from_r, hn::Mul(hn::Sub(h, from_h), slope));
    }
};

/// AxialRay, for each lane.
struct AxialRays {
    Vec t_reference;
    Vec from_axis[3];
    Vec across[3];
    Vec height;
    Vec rise;
    Vec a;
    Vec b;
    Vec c;
    Mask flat;
    Vec height_of_origin;
    Vec origin_from_axis[3];
};

HWY_INLINE AxialRays
axial_rays(const Frame& frame, const MantleRows& mantles, std::size_t lane, Vec start_h) {
    const Doubles d;
    const Vec zero = hn::Zero(d);
    Vec direction[3];
    load3(frame.rays.direction, lane, direction);
    Vec axis[3];
    load3(mantles.axis, lane, axis);
    Vec from_base[3];
    for (std::size_t i = 0; i < 3; ++i)
        from_base[i] = hn::Sub(row(frame.rays.origin[i], lane), row(mantles.base[i], lane));
    const Vec height = dot3(from_base, axis);
    const Vec rise = dot3(direction, axis);
    Vec from_axis[3];
    Vec across[3];
    for (std::size_t i = 0; i < 3; ++i) {
        from_axis[i] = hn::Sub(from_base[i], hn::Mul(height, axis[i]));
        across[i] = hn::Sub(direction[i], hn::Mul(rise, axis[i]));
    }
    const Vec a = dot3(across, across);
    const Mask flat = hn::Gt(a, hn::Mul(rise, rise));
    const Vec t_reference = hn::Div(
        hn::IfThenElse(flat, hn::Neg(dot3(from_axis, across)), hn::Sub(start_h, height)),
        hn::IfThenElse(flat, a, rise));
    Vec moved[3];
    for (std::size_t i = 0; i < 3; ++i)
        moved[i] = hn::Add(from_axis[i], hn::Mul(t_reference, across[i]));
    return {
        t_reference,
        {moved[0], moved[1], moved[2]},
        {across[0], across[1], across[2]},
        hn::IfThenElse(flat, hn::Add(height, hn::Mul(t_reference, rise)), start_h),
        rise,
        a,
        hn::IfThenElse(flat, zero, dot3(moved, across)),
        dot3(moved, moved),
        flat,
        height,
        {from_axis[0], from_axis[1], from_axis[2]}};
}

/// The lanes whose rays start on the mantle, and maybe some others.
HWY_INLINE Mask may_start(
    const Frame& frame,
    const MantleRows& mantles,
    std::size_t lane,
    const AxialRays& axial,
    const Lines& line,
    Vec reach) {
    const Doubles d;
    Vec base[3];
    load3(mantles.base, lane, base);
    const Vec near =
        hn::Mul(hn::Set(d, 1.75), start_distance(frame, lane, hn::Add(largest3(base), reach)));
    const Vec steepness = hn::Sqrt(hn::Add(hn::Set(d, 1), hn::Mul(line.slope, line.slope)));
    const Vec radius = hn::Sqrt(dot3(axial.origin_from_axis, axial.origin_from_axis));
    const Vec off = hn::Abs(hn::Sub(radius, line.radius_at(axial.height_of_origin)));
    const Vec largest = largest3(axial.origin_from_axis);
    // Otherwise the radius is not what length() tells.
    const Mask is_usual =
        hn::And(hn::Gt(largest, hn::Set(d, 1e-140)), hn::Lt(largest, hn::Set(d, 1e140)));
    return hn::And(
        hn::Ge(row(frame.rays.t_min, lane), hn::Zero(d)),
        hn::Or(hn::Not(is_usual), hn::Le(off, hn::Mul(near, steepness))));
}

/// The operations of AxialRay and for_each_cone_crossing(), in their order.
HWY_INLINE void cross_part(
    const Frame& frame,
    const MantleRows& mantles,
    LaneMask starting,
    std::size_t lane,
    RoundCrossings& crossings) {
    const Doubles d;
    const Vec zero = hn::Zero(d);
    const Vec part = hn::Set(d, uncertain_part);
    const Vec from_r = row(mantles.start_r, lane);
    const Vec from_h = row(mantles.start_h, lane);
    const Vec to_r = row(mantles.end_r, lane);
    const Vec to_h = row(mantles.end_h, lane);
    const Lines line = {
        from_r, from_h, to_r, to_h, hn::Div(hn::Sub(to_r, from_r), hn::Sub(to_h, from_h))};
    const Vec reach = hn::Max(hn::Max(from_r, to_r), hn::Max(hn::Abs(from_h), hn::Abs(to_h)));
    const AxialRays axial = axial_rays(frame, mantles, lane, from_h);

    const Vec k = hn::Mul(axial.rise, line.slope);
    const Vec p = line.radius_at(axial.height);
    const auto& f = axial.from_axis;
    const auto& g = axial.across;
    Vec sum[3];
    for (std::size_t i = 0; i < 3; ++i)
        sum[i] = hn::Sub(hn::Mul(p, g[i]), hn::Mul(k, f[i]));
    const Vec area[3] = {
        hn::Sub(hn::Mul(f[1], g[2]), hn::Mul(f[2], g[1])),
        hn::Sub(hn::Mul(f[2], g[0]), hn::Mul(f[0], g[2])),
        hn::Sub(hn::Mul(f[0], g[1]), hn::Mul(f[1], g[0]))};
    const Vec discriminant = hn::Sub(
        dot3(sum, sum), hn::IfThenElse(axial.flat, hn::Mul(axial.a, axial.c), dot3(area, area)));
    const Vec margin_of_contact =
        hn::Mul(part, hn::Add(hn::Mul(hn::Mul(p, p), axial.a), hn::Mul(hn::Mul(k, k), axial.c)));
    const Mask passes = hn::Ge(discriminant, hn::Neg(margin_of_contact));
    Mask undecided = hn::Or(
        may_start(frame, mantles, lane, axial, line, reach),
        hn::Lt(discriminant, margin_of_contact));

    const Vec half = hn::Sub(axial.b, hn::Mul(p, k));
    const Vec root = hn::Sqrt(discriminant);
    const Vec larger =
        hn::IfThenElse(hn::Gt(half, zero), hn::Sub(hn::Neg(half), root), hn::Sub(root, half));
    const Vec radius = hn::Sqrt(axial.c);
    const Vec both[2] = {
        hn::Div(larger, hn::Sub(axial.a, hn::Mul(k, k))),
        hn::Div(hn::Mul(hn::Sub(radius, p), hn::Add(radius, p)), larger)};
    const Vec margin = hn::Mul(part, hn::Add(reach, hn::Abs(axial.height)));
    Mask met[2];
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec h = hn::Add(axial.height, hn::Mul(both[i], axial.rise));
        undecided = hn::Or(
            undecided,
            hn::Or(
                hn::Le(hn::Abs(hn::Sub(h, from_h)), margin),
                hn::Le(hn::Abs(hn::Sub(h, to_h)), margin)));
        met[i] = hn::And(hn::Ge(h, hn::Min(from_h, to_h)), hn::Le(h, hn::Max(from_h, to_h)));
    }
    undecided = hn::Or(hn::And(passes, undecided), mask_of(starting, lane));
    crossings.undecided |= bits(undecided, lane);
    const Mask settled = hn::AndNot(undecided, passes);
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec t = hn::Add(axial.t_reference, both[i]);
        put(crossings, i, hn::And(hn::And(settled, met[i]), covers(frame, lane, t)), t, lane);
    }
}

template <typename Rows>
HWY_INLINE void cross_all(
    const Frame& frame,
    LaneMask lanes,
    LaneMask starting,
    const Rows& rows,
    RoundCrossings& crossings) {
    crossings.undecided = crossings.met[0] = crossings.met[1] = 0;
    for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(Doubles()))
        if (any_in_vector(lanes, lane))
            cross_part(frame, rows, starting, lane, crossings);
    crossings.undecided &= lanes;
    for (LaneMask& met : crossings.met)
        met &= lanes;
}

void cross_spheres_kernel(
    const Frame& frame,
    LaneMask lanes,
    LaneMask starting,
    const SphereRows& spheres,
    RoundCrossings& crossings) {
    cross_all(frame, lanes, starting, spheres, crossings);
}

void cross_mantles_kernel(
    const Frame& frame,
    LaneMask lanes,
    LaneMask starting,
    const MantleRows& mantles,
    RoundCrossings& crossings) {
    cross_all(frame, lanes, starting, mantles, crossings);
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vera::detail {

HWY_EXPORT(cross_spheres_kernel);
HWY_EXPORT(cross_mantles_kernel);

void cross_spheres(
    const Frame& frame,
    LaneMask lanes,
    LaneMask starting,
    const SphereRows& spheres,
    RoundCrossings& crossings) {
    HWY_DYNAMIC_DISPATCH(cross_spheres_kernel)(frame, lanes, starting, spheres, crossings);
}

void cross_mantles(
    const Frame& frame,
    LaneMask lanes,
    LaneMask starting,
    const MantleRows& mantles,
    RoundCrossings& crossings) {
    HWY_DYNAMIC_DISPATCH(cross_mantles_kernel)(frame, lanes, starting, mantles, crossings);
}

} // namespace vera::detail

#endif
