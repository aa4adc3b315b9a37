// SPDX-License-Identifier: Apache-2.0
// The cheap tests of rays with elements, in single precision: compiled once for each instruction
// set, and so included once for each, by the searches alone.
//
// The lanes of a vector are rays that are tested against one element, or elements that one ray is
// tested against: what is one has its numbers in all lanes. may_meet() returns the lanes in which
// the ray, moved by up to slack, may meet the element before its limit; surely_meets() those in
// which it meets the element wherever it is moved to, and surely_leaves() those in which a ray that
// starts on the element does not meet it again. What is neither sure nor ruled out is for the test
// that decides.

#if defined(VERA_ACCEL_ELEMENT_TESTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_ELEMENT_TESTS_INL_H
#undef VERA_ACCEL_ELEMENT_TESTS_INL_H
#else
#define VERA_ACCEL_ELEMENT_TESTS_INL_H
#endif

#include "vera/accel/element_records.h"
#include "vera/accel/flat_tests-inl.h"
#include "vera/accel/round_tests-inl.h"
#include "vera/accel/tested_rays-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <typename D>
HWY_INLINE hn::Mask<D> none(D d) {
    return hn::Lt(hn::Zero(d), hn::Zero(d));
}

/// The test of elements of this kind; values as in their records.
template <typename D>
HWY_INLINE hn::Mask<D>
may_meet(D d, const TestedRays<D>& rays, ElementRecord::Kind kind, const hn::Vec<D>* values) {
    switch (kind) {
    case ElementRecord::Kind::sphere:
        return meets_ball(d, rays, values, hn::Add(values[3], hn::Set(d, 2 * rays.slack)));
    case ElementRecord::Kind::triangle:
        return meeting_face(d, rays, triangle_place(d, rays, face_of(d, values))).may;
    case ElementRecord::Kind::quadrangle:
        return meeting_face(d, rays, quadrangle_place(d, rays, values)).may;
    case ElementRecord::Kind::mantle:
        return meeting_mantle(d, rays, values).may;
    case ElementRecord::Kind::cylinder:
        return meets_cylinder(d, rays, values);
    case ElementRecord::Kind::box:
    case ElementRecord::Kind::call:
        break;
    }
    return meets_box(d, rays, values);
}

/// For rays that do not start on the element.
template <typename D>
HWY_INLINE hn::Mask<D>
surely_meets(D d, const TestedRays<D>& rays, ElementRecord::Kind kind, const hn::Vec<D>* values) {
    switch (kind) {
    case ElementRecord::Kind::sphere:
        return meeting_ball(d, rays, values, values[3]).sure;
    case ElementRecord::Kind::triangle:
        return meeting_face(d, rays, triangle_place(d, rays, face_of(d, values))).sure;
    case ElementRecord::Kind::quadrangle:
        return meeting_face(d, rays, quadrangle_place(d, rays, values)).sure;
    case ElementRecord::Kind::mantle:
        return meeting_mantle(d, rays, values).sure;
    case ElementRecord::Kind::cylinder:
    case ElementRecord::Kind::box:
    case ElementRecord::Kind::call:
        break;
    }
    return none(d);
}

/// For rays that start on the element.
template <typename D>
HWY_INLINE hn::Mask<D>
surely_leaves(D d, const TestedRays<D>& rays, ElementRecord::Kind kind, const hn::Vec<D>* values) {
    switch (kind) {
    case ElementRecord::Kind::sphere:
        return hn::Lt(center_place(rays, values).closest, hn::Set(d, -4 * rays.slack));
    case ElementRecord::Kind::triangle:
    case ElementRecord::Kind::quadrangle:
        return hn::Not(none(d));
    case ElementRecord::Kind::mantle: {
        // Outwards: the other place where it meets the cone lies behind it.
        const auto place = cone_place(d, rays, values);
        return hn::And(
            place.is_known,
            hn::Lt(place.middle, hn::Mul(hn::Mul(place.error, hn::Set(d, -8)), place.per_square)));
    }
    case ElementRecord::Kind::cylinder:
    case ElementRecord::Kind::box:
    case ElementRecord::Kind::call:
        break;
    }
    return none(d);
}

/// Rules out most of the rays that do not meet an element of the kind, in little time.
template <typename D>
HWY_INLINE hn::Mask<D>
may_come_near(D d, const TestedRays<D>& rays, ElementRecord::Kind kind, const hn::Vec<D>* values) {
    return kind == ElementRecord::Kind::mantle ? may_meet_cone(d, rays, values)
                                               : may_meet(d, rays, kind, values);
}

/// Both may_meet() and surely_meets(), and between which distances.
template <typename D>
HWY_INLINE Meeting<D>
meeting(D d, const TestedRays<D>& rays, ElementRecord::Kind kind, const hn::Vec<D>* values) {
    switch (kind) {
    case ElementRecord::Kind::triangle:
        return meeting_face(d, rays, triangle_place(d, rays, face_of(d, values)));
    case ElementRecord::Kind::quadrangle:
        return meeting_face(d, rays, quadrangle_place(d, rays, values));
    case ElementRecord::Kind::sphere:
        return meeting_ball(d, rays, values, values[3]);
    case ElementRecord::Kind::mantle:
        return meeting_mantle(d, rays, values);
    default:
        break;
    }
    return {
        may_meet(d, rays, kind, values),
        surely_meets(d, rays, kind, values),
        hn::Zero(d),
        rays.limit};
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
