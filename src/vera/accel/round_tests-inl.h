// SPDX-License-Identifier: Apache-2.0
// The cheap tests of rays with spheres, cylinders and mantles of cones, in single precision: see
// element_tests-inl.h.
//
// Places are filled as they are made: GCC gives a constructor that it makes itself none of the
// instructions of its place, and some vectors have constructors that then cannot be inlined.

#if defined(VERA_ACCEL_ROUND_TESTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_ROUND_TESTS_INL_H
#undef VERA_ACCEL_ROUND_TESTS_INL_H
#else
#define VERA_ACCEL_ROUND_TESTS_INL_H
#endif

#include "vera/accel/tested_rays-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Where rays pass a center.
template <typename V>
struct CenterPlace {
    V to_center[3];     ///< from the origin
    V closest;          ///< t where they are nearest to it
    V distance_squared; ///< there
};

template <typename D>
HWY_INLINE CenterPlace<hn::Vec<D>>
center_place(const TestedRays<D>& rays, const hn::Vec<D>* center) {
    using V = hn::Vec<D>;
    const V to_center[3] = {
        hn::Sub(center[0], rays.origin[0]),
        hn::Sub(center[1], rays.origin[1]),
        hn::Sub(center[2], rays.origin[2])};
    const V closest = fused_dot3(to_center, rays.direction);
    const V offset[3] = {
        hn::Sub(to_center[0], hn::Mul(closest, rays.direction[0])),
        hn::Sub(to_center[1], hn::Mul(closest, rays.direction[1])),
        hn::Sub(to_center[2], hn::Mul(closest, rays.direction[2]))};
    return {{to_center[0], to_center[1], to_center[2]}, closest, fused_dot3(offset, offset)};
}

template <typename D>
HWY_INLINE hn::Mask<D>
meets_ball(D d, const TestedRays<D>& rays, const hn::Vec<D>* center, hn::Vec<D> radius) {
    using V = hn::Vec<D>;
    const auto place = center_place(rays, center);
    // The part of the ray from 0 to its limit comes as near as it does at the t nearest to closest.
    const V zero = hn::Zero(d);
    const V t = hn::Max(zero, hn::Min(rays.limit, place.closest));
    const V beyond = hn::Sub(place.closest, t);
    const V sum = hn::Add(place.distance_squared, hn::Mul(beyond, beyond));
    const V reach = hn::Mul(hn::Mul(radius, radius), hn::Set(d, up));
    return hn::And(hn::Le(sum, reach), hn::Ge(rays.limit, zero));
}

/// A ray surely meets a sphere that it passes through from one side to the other; where it starts
/// surely outside, by when it has entered it.
template <typename D>
HWY_INLINE Meeting<D>
meeting_ball(D d, const TestedRays<D>& rays, const hn::Vec<D>* center, hn::Vec<D> radius) {
    using V = hn::Vec<D>;
    const auto place = center_place(rays, center);
    const V zero = hn::Zero(d);
    const V margin = hn::Set(d, 4 * rays.slack);
    const V inner = hn::Max(hn::Sub(radius, margin), zero);
    const V outer = hn::Add(radius, margin);
    const V inner_squared = hn::Mul(hn::Mul(inner, inner), hn::Set(d, 2 - up));
    const V outer_squared = hn::Mul(hn::Mul(outer, outer), hn::Set(d, up));
    const V end = sure_limit(d, rays);
    const V t = hn::Max(zero, hn::Min(end, place.closest));
    const V to_t = hn::Sub(place.closest, t);
    const V to_end = hn::Sub(place.closest, end);
    const V start_squared = fused_dot3(place.to_center, place.to_center);
    const V middle_squared = hn::MulAdd(to_t, to_t, place.distance_squared);
    const V end_squared = hn::MulAdd(to_end, to_end, place.distance_squared);
    const auto starts_outside = hn::Gt(start_squared, outer_squared);
    const auto ends_outside = hn::Or(starts_outside, hn::Gt(end_squared, outer_squared));
    // Half the length within the sphere lies between these two.
    const V shorter = hn::Sqrt(hn::Max(zero, hn::Sub(inner_squared, place.distance_squared)));
    const V longer = hn::Sqrt(hn::Max(zero, hn::Sub(outer_squared, place.distance_squared)));
    const V far = hn::IfThenElse(
        starts_outside, hn::Sub(place.closest, shorter), hn::Add(place.closest, longer));
    return {
        meets_ball(d, rays, center, hn::Add(radius, hn::Set(d, 2 * rays.slack))),
        hn::And(hn::And(hn::Lt(middle_squared, inner_squared), ends_outside), hn::Gt(end, zero)),
        hn::Sub(hn::Sub(place.closest, longer), margin),
        hn::Add(far, margin)};
}

/// How the lines of rays pass the axis of a cylinder, at a distance of apart / sine.
template <typename V>
struct AxisPlace {
    V sine_squared; ///< of the angle between them
    V apart;
    V rise;             ///< along the axis for one unit of t
    V height;           ///< of the center above the origin
    V middle_by_square; ///< t where they are nearest to it, times sine_squared
};

template <typename D>
HWY_INLINE AxisPlace<hn::Vec<D>> axis_place(const TestedRays<D>& rays, const hn::Vec<D>* values) {
    using V = hn::Vec<D>;
    const V to_center[3] = {
        hn::Sub(values[0], rays.origin[0]),
        hn::Sub(values[1], rays.origin[1]),
        hn::Sub(values[2], rays.origin[2])};
    const V axis_direction[3] = {values[3], values[4], values[5]};
    V across[3];
    cross3(rays.direction, axis_direction, across);
    const V rise = fused_dot3(rays.direction, axis_direction);
    const V height = fused_dot3(to_center, axis_direction);
    return {
        fused_dot3(across, across),
        hn::Abs(fused_dot3(to_center, across)),
        rise,
        height,
        hn::Sub(fused_dot3(to_center, rays.direction), hn::Mul(height, rise))};
}

template <typename D>
HWY_INLINE hn::Mask<D> meets_cylinder(D d, const TestedRays<D>& rays, const hn::Vec<D>* values) {
    using V = hn::Vec<D>;
    const V radius = values[6];
    const V half = values[7];
    const V slack = hn::Set(d, 2 * rays.slack);
    const V one_up = hn::Set(d, up);
    const V around = hn::Sqrt(hn::Add(hn::Mul(radius, radius), hn::Mul(half, half)));
    const auto round = meets_ball(d, rays, values, hn::Add(hn::Mul(around, one_up), slack));
    const auto place = axis_place(rays, values);
    const V sine = hn::Sqrt(place.sine_squared);
    const V reach =
        hn::Add(hn::Mul(sine, hn::Mul(hn::Add(radius, slack), one_up)), hn::Add(slack, slack));
    const auto near_axis = hn::And(round, hn::Le(place.apart, reach));

    // Where the ray is within reach of the axis, from t = middle - chord to middle + chord, it must
    // be at the cylinder's heights as well. Of rays almost along the axis that is not asked: their
    // middle is badly known.
    const V steep = hn::Set(d, 0.05F);
    const V per_square = hn::Div(hn::Set(d, 1), hn::Max(place.sine_squared, hn::Mul(steep, steep)));
    const V middle = hn::Mul(place.middle_by_square, per_square);
    const V chord_squared =
        hn::Max(hn::Zero(d), hn::Sub(hn::Mul(reach, reach), hn::Mul(place.apart, place.apart)));
    // |middle| is at most a few units over the sine's square; its rounding is far below this.
    const V margin = hn::Mul(slack, hn::Mul(per_square, hn::Set(d, 4)));
    const V chord = hn::Add(hn::Mul(hn::Sqrt(chord_squared), per_square), margin);
    const V middle_height = hn::Abs(hn::Sub(hn::Mul(middle, place.rise), place.height));
    const V heights = hn::Add(
        hn::Add(hn::Mul(half, one_up), hn::Add(slack, slack)), hn::Mul(chord, hn::Abs(place.rise)));
    const auto in_range = hn::And(
        hn::Ge(hn::Add(middle, chord), hn::Zero(d)), hn::Le(hn::Sub(middle, chord), rays.limit));
    const auto at_heights = hn::And(in_range, hn::Le(middle_height, heights));
    return hn::And(near_axis, hn::Or(at_heights, hn::Lt(sine, steep)));
}

/// Where the lines of rays meet the infinite cone, or cylinder, that a mantle is a part of: at
/// t = middle -+ sqrt(breadth^2 - apart^2) per_square.
template <typename D>
struct ConePlace {
    AxisPlace<hn::Vec<D>> axis;
    hn::Vec<D> per_square;
    hn::Vec<D> middle;
    hn::Vec<D> breadth_squared;
    hn::Vec<D> error;     ///< of breadth and of heights, at most
    hn::Mask<D> is_known; ///< the ray runs neither along the axis nor along the cone
};

/// The largest of three numbers without their signs.
template <typename D>
HWY_INLINE hn::Vec<D> largest_of(D, const hn::Vec<D> (&v)[3]) {
    return hn::Max(hn::Abs(v[0]), hn::Max(hn::Abs(v[1]), hn::Abs(v[2])));
}

/// At height h over the center the mantle is radius + slope h away from the axis. With p that at
/// the origin's height and q its growth for one unit of t, the ray meets the cone where (sine^2 -
/// q^2) t^2 + 2 (b - p q) t + c - p^2 = 0, if b and c are those of the squared distance of the ray
/// from the axis. The discriminant is the difference of the squares of two lengths, |p across - q
/// from_axis| and apart, in which less cancels.
///
/// What is small lies often in a large scene, so that its size and distances count here, and not
/// the slack that holds for the whole scene. The numbers are up to 130 * 2^-24 of them off, with
/// what moving the ray does to them.
template <typename D>
HWY_INLINE ConePlace<D> cone_place(D d, const TestedRays<D>& rays, const hn::Vec<D>* values) {
    using V = hn::Vec<D>;
    const auto axis = axis_place(rays, values);
    const V p = hn::NegMulAdd(values[8], axis.height, values[6]);
    const V q = hn::Mul(values[8], axis.rise);
    const V along_axis = hn::MulAdd(p, axis.rise, hn::Mul(q, axis.height));
    const V to_center[3] = {
        hn::Sub(values[0], rays.origin[0]),
        hn::Sub(values[1], rays.origin[1]),
        hn::Sub(values[2], rays.origin[2])};
    const auto component = [&](std::size_t i) HWY_ATTR {
        const V along_ray = hn::MulAdd(p, rays.direction[i], hn::Mul(q, to_center[i]));
        return hn::NegMulAdd(along_axis, values[3 + i], along_ray);
    };
    const V breadth[3] = {component(0), component(1), component(2)};
    const V size =
        hn::Add(hn::Add(largest_of(d, to_center), largest_of(d, rays.origin)), hn::Abs(values[6]));
    const V square = hn::NegMulAdd(q, q, axis.sine_squared);
    const V per_square = hn::Div(hn::Set(d, 1), square);
    return {
        axis,
        per_square,
        hn::Mul(hn::MulAdd(p, q, axis.middle_by_square), per_square),
        fused_dot3(breadth, breadth),
        hn::MulAdd(size, hn::Set(d, 0x1p-17F), hn::Set(d, 4 * rays.double_slack)),
        hn::And(
            hn::Gt(axis.sine_squared, hn::Set(d, 0.01F)),
            hn::Gt(square, hn::Mul(hn::Set(d, 0.25F), axis.sine_squared)))};
}

/// The rays whose lines may meet the cone of the mantle, and those of which that is not known:
/// those for which breadth + error >= apart, and maybe a few more. The root that breadth is would
/// have to be waited for.
template <typename D>
HWY_INLINE hn::Mask<D> may_meet_cone(D d, const TestedRays<D>& rays, const hn::Vec<D>* values) {
    const auto place = cone_place(d, rays, values);
    const auto beyond = hn::Max(hn::Sub(place.axis.apart, place.error), hn::Zero(d));
    const auto outside =
        hn::Gt(hn::Mul(beyond, beyond), hn::Mul(place.breadth_squared, hn::Set(d, up * up)));
    return hn::Not(hn::And(outside, place.is_known));
}

/// A ray meets a mantle where it enters the whole cone between the heights of the mantle's ends, or
/// leaves it there.
template <typename D>
HWY_INLINE Meeting<D> meeting_mantle(D d, const TestedRays<D>& rays, const hn::Vec<D>* values) {
    using V = hn::Vec<D>;
    const auto place = cone_place(d, rays, values);
    const V zero = hn::Zero(d);
    const V margin = place.error;

    // Half the length of the line within the cone lies between these two.
    const V breadth = hn::Sqrt(place.breadth_squared);
    const V inner = hn::Sub(breadth, margin);
    const V outer = hn::Add(breadth, margin);
    const V apart_squared = hn::Mul(place.axis.apart, place.axis.apart);
    const auto half_length = [&](V reach) HWY_ATTR {
        const V squared = hn::Sub(hn::Mul(reach, reach), apart_squared);
        return hn::Mul(hn::Sqrt(hn::Max(zero, squared)), place.per_square);
    };
    const V shorter = half_length(inner);
    const V longer = half_length(outer);
    // The square itself is off by up to 2^-19 sines, and is a quarter of their square at least.
    const V off = hn::Mul(hn::Mul(margin, hn::Set(d, 8)), place.per_square);

    const V end = sure_limit(d, rays);
    const V shortest = hn::Sub(values[7], margin);
    const V longest = hn::Add(values[7], margin);

    struct Crossing {
        V first;
        V last;
        hn::Mask<D> may;
        hn::Mask<D> sure;
    };

    const auto between = [&](V first, V last) HWY_ATTR {
        const V at_first = hn::MulSub(first, place.axis.rise, place.axis.height);
        const V at_last = hn::MulSub(last, place.axis.rise, place.axis.height);
        const V lowest = hn::Min(at_first, at_last);
        const V highest = hn::Max(at_first, at_last);
        return Crossing{
            first,
            last,
            hn::And(
                hn::And(hn::Ge(last, zero), hn::Le(first, rays.limit)),
                hn::And(hn::Le(lowest, longest), hn::Ge(highest, hn::Neg(longest)))),
            hn::And(
                hn::And(hn::Gt(first, margin), hn::Lt(last, end)),
                hn::And(hn::Le(highest, shortest), hn::Ge(lowest, hn::Neg(shortest))))};
    };
    const Crossing enters = between(
        hn::Sub(hn::Sub(place.middle, longer), off), hn::Add(hn::Sub(place.middle, shorter), off));
    const Crossing leaves = between(
        hn::Sub(hn::Add(place.middle, shorter), off), hn::Add(hn::Add(place.middle, longer), off));
    const auto touches = hn::And(place.is_known, hn::Ge(outer, place.axis.apart));
    const auto passes = hn::And(place.is_known, hn::Gt(inner, place.axis.apart));
    Meeting<D> result = {
        hn::And(touches, hn::Or(enters.may, leaves.may)),
        hn::And(passes, hn::Or(enters.sure, leaves.sure)),
        hn::IfThenElseZero(place.is_known, hn::IfThenElse(enters.may, enters.first, leaves.first)),
        hn::IfThenElse(enters.sure, enters.last, leaves.last)};
    if (!hn::AllTrue(d, place.is_known)) {
        const V around[8] = {
            values[0],
            values[1],
            values[2],
            values[3],
            values[4],
            values[5],
            hn::MulAdd(hn::Abs(values[8]), values[7], values[6]),
            values[7]};
        result.may =
            hn::Or(result.may, hn::AndNot(place.is_known, meets_cylinder(d, rays, around)));
    }
    return result;
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
