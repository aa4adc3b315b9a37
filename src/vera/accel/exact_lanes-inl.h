// SPDX-License-Identifier: Apache-2.0
// What the kernels that decide share: a packet's rays as vectors of doubles. Compiled once for each
// instruction set.

#if defined(VERA_ACCEL_EXACT_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_EXACT_LANES_INL_H
#undef VERA_ACCEL_EXACT_LANES_INL_H
#else
#define VERA_ACCEL_EXACT_LANES_INL_H
#endif

#include "vera/accel/packet_query.h"

#include <cstddef>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, packet_size>;
using Vec = hn::Vec<Doubles>;
using Mask = hn::Mask<Doubles>;

HWY_INLINE Vec row(const RayRows::Row& values, std::size_t lane) {
    return hn::Load(Doubles(), values.data() + lane);
}

HWY_INLINE void store(Vec value, RayRows::Row& values, std::size_t lane) {
    hn::Store(value, Doubles(), values.data() + lane);
}

HWY_INLINE LaneMask bits(Mask mask, std::size_t lane) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Doubles(), mask, bytes);
    return (LaneMask{bytes[0]} & ((LaneMask{1} << hn::Lanes(Doubles())) - 1)) << lane;
}

/// Whether some of the lanes are among those of the vector that begins with this one.
HWY_INLINE bool any_in_vector(LaneMask lanes, std::size_t lane) {
    constexpr std::size_t width = hn::MaxLanes(Doubles());
    return (lanes >> lane & ((LaneMask{1} << width) - 1)) != 0;
}

HWY_INLINE Vec sum3(Vec a, Vec b, Vec c) {
    return hn::Add(hn::Add(a, b), c);
}

/// dot()
HWY_INLINE Vec dot3(const Vec (&a)[3], const Vec (&b)[3]) {
    return sum3(hn::Mul(a[0], b[0]), hn::Mul(a[1], b[1]), hn::Mul(a[2], b[2]));
}

HWY_INLINE Vec largest3(const Vec (&a)[3]) {
    return hn::Max(hn::Max(hn::Abs(a[0]), hn::Abs(a[1])), hn::Abs(a[2]));
}

/// PreparedRay::covers()
HWY_INLINE Mask covers(const Frame& frame, std::size_t lane, Vec t) {
    return hn::And(
        hn::And(hn::Ge(t, row(frame.rays.t_min, lane)), hn::Le(t, row(frame.rays.t_max, lane))),
        hn::Le(hn::Abs(t), hn::Set(Doubles(), std::numeric_limits<double>::max())));
}

/// The coordinate along one of three axes, which lanes choose by being in one of two masks or not.
HWY_INLINE Vec chosen(Mask first, Vec a, Mask second, Vec b, Vec c) {
    return hn::IfThenElse(first, a, hn::IfThenElse(second, b, c));
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
