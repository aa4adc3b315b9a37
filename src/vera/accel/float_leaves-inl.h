// SPDX-License-Identifier: Apache-2.0
// What is computed at leaves of a tree of boxes, whatever its elements are: see float_search-inl.h.
// Compiled once for each instruction set.

#if defined(VERA_ACCEL_FLOAT_LEAVES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_FLOAT_LEAVES_INL_H
#undef VERA_ACCEL_FLOAT_LEAVES_INL_H
#else
#define VERA_ACCEL_FLOAT_LEAVES_INL_H
#endif

#include "vera/accel/float_rays-inl.h"
#include "vera/accel/float_tree.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Elements of a leaf that are looked at together.
using LeafLanes = hn::CappedTag<float, most_in_leaf>;

/// Numbers that decide: as many as one byte has mask bits.
using DecidingLanes = hn::CappedTag<double, 8>;

template <typename V>
struct Vector {
    V x;
    V y;
    V z;
};

template <typename V>
HWY_INLINE Vector<V> difference(const Vector<V>& a, const Vector<V>& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

template <typename V>
HWY_INLINE V product(const Vector<V>& a, const Vector<V>& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

template <typename V>
HWY_INLINE Vector<V> cross_product(const Vector<V>& a, const Vector<V>& b) {
    return {
        hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)),
        hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
        hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

template <typename V>
HWY_INLINE Vector<V> absolute(const Vector<V>& a) {
    return {hn::Abs(a.x), hn::Abs(a.y), hn::Abs(a.z)};
}

template <typename V>
HWY_INLINE V sum_of(const Vector<V>& a) {
    return hn::Add(hn::Add(a.x, a.y), a.z);
}

template <typename V>
HWY_INLINE V largest(const Vector<V>& a) {
    return hn::Max(hn::Abs(a.x), hn::Max(hn::Abs(a.y), hn::Abs(a.z)));
}

template <typename D>
HWY_INLINE Vector<hn::Vec<D>> same_for_all(D d, const float* coordinates) {
    return {hn::Set(d, coordinates[0]), hn::Set(d, coordinates[1]), hn::Set(d, coordinates[2])};
}

/// In the order of operations of dot().
template <typename D>
HWY_INLINE hn::Vec<D> dot_in_order(const Vector<hn::Vec<D>>& a, const Vector<hn::Vec<D>>& b, D) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

template <typename D>
HWY_INLINE Vector<hn::Vec<D>>
cross_in_order(const Vector<hn::Vec<D>>& a, const Vector<hn::Vec<D>>& b, D) {
    return {
        hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
        hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
        hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

/// How rays meet elements.
template <typename D>
struct FloatMeeting {
    hn::Mask<D> may;  ///< false: surely not, or not before the limit
    hn::Mask<D> sure; ///< true: surely, and after near and before far
    hn::Vec<D> near;
    hn::Vec<D> far;
};

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
