// SPDX-License-Identifier: Apache-2.0
// Rays as the cheap tests in single precision take them, and what such a test tells: see
// element_tests-inl.h.

#if defined(VERA_ACCEL_TESTED_RAYS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_TESTED_RAYS_INL_H
#undef VERA_ACCEL_TESTED_RAYS_INL_H
#else
#define VERA_ACCEL_TESTED_RAYS_INL_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <typename V>
HWY_INLINE V fused_dot3(const V (&a)[3], const V (&b)[3]) {
    return hn::MulAdd(a[2], b[2], hn::MulAdd(a[1], b[1], hn::Mul(a[0], b[0])));
}

template <typename V>
HWY_INLINE void cross3(const V (&a)[3], const V (&b)[3], V (&result)[3]) {
    result[0] = hn::NegMulAdd(a[2], b[1], hn::Mul(a[1], b[2]));
    result[1] = hn::NegMulAdd(a[0], b[2], hn::Mul(a[2], b[0]));
    result[2] = hn::NegMulAdd(a[1], b[0], hn::Mul(a[0], b[1]));
}

/// Rays in local coordinates: see Frame.
template <typename D>
struct TestedRays {
    using V = hn::Vec<D>;

    V origin[3];
    V direction[3];
    V inverse[3];
    V limit;
    float slack;
    float double_slack; ///< as in Frame
};

/// Squares of sums are rounded by a few units of 2^-24.
constexpr float up = 1 + 0x1p-20F;

/// Before it a ray, moved by up to slack, has surely not come to its end.
template <typename D>
HWY_INLINE hn::Vec<D> sure_limit(D d, const TestedRays<D>& rays) {
    return hn::Sub(rays.limit, hn::Set(d, 16 * rays.slack));
}

/// Where rays meet an element, if they do: those that may, those that surely do, before which local
/// distance they surely do not, and, for those that surely do, by which they have.
template <typename D>
struct Meeting {
    hn::Mask<D> may;
    hn::Mask<D> sure;
    hn::Vec<D> near;
    hn::Vec<D> far;
};

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
