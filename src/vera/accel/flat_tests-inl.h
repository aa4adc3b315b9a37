// SPDX-License-Identifier: Apache-2.0
// The cheap tests of rays with faces and boxes, in single precision: see element_tests-inl.h.
//
// Places are filled as they are made: GCC gives a constructor that it makes itself none of the
// instructions of its place, and some vectors have constructors that then cannot be inlined.

#if defined(VERA_ACCEL_FLAT_TESTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_FLAT_TESTS_INL_H
#undef VERA_ACCEL_FLAT_TESTS_INL_H
#else
#define VERA_ACCEL_FLAT_TESTS_INL_H
#endif

#include "vera/accel/tested_rays-inl.h"

#include <limits>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A corner of a face and the edges from there, and what follows from them.
template <typename V>
struct Face {
    V corner[3];
    V e[3];
    V f[3];
    V normal[3];
    V largest;      ///< of the components of e and f, without their signs
    V normal_error; ///< how much a ray that is moved by 1 may change a product with the normal
};

/// From the values of a triangle's or quadrangle's record.
template <typename D>
HWY_INLINE Face<hn::Vec<D>> face_of(D d, const hn::Vec<D>* values) {
    using V = hn::Vec<D>;
    const V e[3] = {values[3], values[4], values[5]};
    const V f[3] = {values[6], values[7], values[8]};
    V normal[3];
    cross3(e, f, normal);
    const V largest_e = hn::Max(hn::Abs(e[0]), hn::Max(hn::Abs(e[1]), hn::Abs(e[2])));
    const V largest_f = hn::Max(hn::Abs(f[0]), hn::Max(hn::Abs(f[1]), hn::Abs(f[2])));
    // The normal's own components are off by up to 8 * 2^-24 of the product of the largest ones,
    // which counts over the 6 units from the corner to where the ray meets the plane, along all
    // axes.
    const V normal_size =
        hn::Add(hn::Add(hn::Abs(normal[0]), hn::Abs(normal[1])), hn::Abs(normal[2]));
    return {
        {values[0], values[1], values[2]},
        {e[0], e[1], e[2]},
        {f[0], f[1], f[2]},
        {normal[0], normal[1], normal[2]},
        hn::Max(largest_e, largest_f),
        hn::Add(
            hn::Add(normal_size, normal_size),
            hn::Mul(hn::Set(d, 1.5F), hn::Mul(largest_e, largest_f)))};
}

/// Where rays meet the plane of a face: at corner + (u e + v f) / speed, and there t is
/// depth / speed.
template <typename V>
struct PlanePlace {
    V u;
    V v;
    V speed;
    V depth;
    V largest; ///< the face's
    V normal_error;
};

/// The same, and whether that is within the face: it is if the numbers from lowest to highest, one
/// for each side and each off by up to error, have one sign.
template <typename V>
struct FacePlace {
    PlanePlace<V> plane;
    V lowest;
    V highest;
    V error;
};

template <typename D>
HWY_INLINE PlanePlace<hn::Vec<D>>
plane_place(D, const TestedRays<D>& rays, const Face<hn::Vec<D>>& face) {
    using V = hn::Vec<D>;
    const V to_corner[3] = {
        hn::Sub(face.corner[0], rays.origin[0]),
        hn::Sub(face.corner[1], rays.origin[1]),
        hn::Sub(face.corner[2], rays.origin[2])};
    V moment[3];
    cross3(to_corner, rays.direction, moment);
    return {
        fused_dot3(moment, face.f),
        hn::Neg(fused_dot3(moment, face.e)),
        fused_dot3(face.normal, rays.direction),
        fused_dot3(face.normal, to_corner),
        face.largest,
        face.normal_error};
}

template <typename D>
HWY_INLINE FacePlace<hn::Vec<D>>
triangle_place(D d, const TestedRays<D>& rays, const Face<hn::Vec<D>>& face) {
    const auto place = plane_place(d, rays, face);
    const auto w = hn::Sub(hn::Sub(place.speed, place.u), place.v);
    // Moving the ray by slack changes a volume with an edge by at most slack times the edge's
    // length, which is at most sqrt(3) times its largest component; the third is a sum of two.
    return {
        place,
        hn::Min(hn::Min(place.u, place.v), w),
        hn::Max(hn::Max(place.u, place.v), w),
        hn::Mul(hn::Set(d, 4 * rays.slack), place.largest)};
}

template <typename D>
HWY_INLINE FacePlace<hn::Vec<D>>
quadrangle_place(D d, const TestedRays<D>& rays, const hn::Vec<D>* values) {
    using V = hn::Vec<D>;
    const auto place = plane_place(d, rays, face_of(d, values));
    // Left of the sides from (1, 0) to the fourth corner (x, y) and from there to (0, 1).
    const V one = hn::Set(d, 1);
    const V x = values[9];
    const V y = values[10];
    const V side =
        hn::Sub(hn::Mul(hn::Sub(x, one), place.v), hn::Mul(y, hn::Sub(place.u, place.speed)));
    const V other =
        hn::Sub(hn::Mul(hn::Sub(y, one), place.u), hn::Mul(x, hn::Sub(place.v, place.speed)));
    const V sizes = hn::Add(one, hn::Add(hn::Abs(x), hn::Abs(y)));
    return {
        place,
        hn::Min(hn::Min(place.u, place.v), hn::Min(side, other)),
        hn::Max(hn::Max(place.u, place.v), hn::Max(side, other)),
        hn::Mul(hn::Mul(hn::Set(d, 8 * rays.slack), place.largest), sizes)};
}

/// Sure only of rays that do not start on the face.
template <typename D>
HWY_INLINE Meeting<D>
meeting_face(D d, const TestedRays<D>& rays, const FacePlace<hn::Vec<D>>& face) {
    using V = hn::Vec<D>;
    const PlanePlace<V>& place = face.plane;
    const V slack = hn::Set(d, rays.slack);
    const V size = hn::Abs(place.speed);
    const V t_size = hn::Mul(place.depth, hn::CopySignToAbs(hn::Set(d, 1), place.speed));
    const V deep = hn::Mul(slack, place.normal_error);
    const V deeper = hn::Add(deep, deep);
    const V near_size = hn::Sub(t_size, deep);
    const V far_size = hn::Add(t_size, deeper);
    const auto in_outline =
        hn::Or(hn::Ge(face.lowest, hn::Neg(face.error)), hn::Le(face.highest, face.error));
    const auto in_range = hn::And(
        hn::Ge(hn::Add(t_size, deep), hn::Neg(hn::Mul(slack, size))),
        hn::Le(near_size, hn::Mul(rays.limit, size)));
    // The same with twice the margins, on the other side.
    const V error = hn::Add(face.error, face.error);
    const auto surely_in_outline =
        hn::Or(hn::Gt(face.lowest, error), hn::Lt(face.highest, hn::Neg(error)));
    const V end = hn::NegMulAdd(hn::Set(d, 4), slack, rays.limit);
    const auto surely_in_range =
        hn::And(hn::Gt(t_size, deeper), hn::Lt(far_size, hn::Mul(end, size)));
    // Not infinite: near would be, too, or no number.
    const V per_size =
        hn::Min(hn::Div(hn::Set(d, 1), size), hn::Set(d, std::numeric_limits<float>::max()));
    return {
        hn::And(in_outline, in_range),
        hn::And(surely_in_outline, surely_in_range),
        hn::Sub(hn::Mul(near_size, per_size), slack),
        hn::Mul(far_size, per_size)};
}

template <typename D>
HWY_INLINE hn::Mask<D> meets_box(D d, const TestedRays<D>& rays, const hn::Vec<D>* values) {
    using V = hn::Vec<D>;
    const V slack = hn::Set(d, 2 * rays.slack);
    V near = hn::Zero(d);
    V far = rays.limit;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const V lower = hn::Sub(hn::Sub(values[axis], slack), rays.origin[axis]);
        const V upper = hn::Sub(hn::Add(values[3 + axis], slack), rays.origin[axis]);
        const V at_lower = hn::Mul(lower, rays.inverse[axis]);
        const V at_upper = hn::Mul(upper, rays.inverse[axis]);
        near = hn::Max(near, hn::Min(at_lower, at_upper));
        far = hn::Min(far, hn::Max(at_lower, at_upper));
    }
    return hn::Le(near, hn::Add(far, slack));
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
