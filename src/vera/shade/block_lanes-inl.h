// SPDX-License-Identifier: Apache-2.0
// Rows of a block as vectors of doubles. Compiled once for each instruction set.

#if defined(VERA_SHADE_BLOCK_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_SHADE_BLOCK_LANES_INL_H
#undef VERA_SHADE_BLOCK_LANES_INL_H
#else
#define VERA_SHADE_BLOCK_LANES_INL_H
#endif

#include "vera/shade/place_blocks.h"

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, block_size>;
using Vec = hn::Vec<Doubles>;
using Mask = hn::Mask<Doubles>;

HWY_INLINE Vec all(double value) {
    return hn::Set(Doubles(), value);
}

HWY_INLINE Vec row(const BlockRow& values, std::size_t lane) {
    return hn::LoadU(Doubles(), values.data() + lane);
}

HWY_INLINE void store(Vec value, BlockRow& values, std::size_t lane) {
    hn::StoreU(value, Doubles(), values.data() + lane);
}

HWY_INLINE BlockLanes bits(Mask mask, std::size_t lane) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Doubles(), mask, bytes);
    return (BlockLanes{bytes[0]} & ((BlockLanes{1} << hn::Lanes(Doubles())) - 1)) << lane;
}

HWY_INLINE Mask mask_of(BlockLanes lanes, std::size_t lane) {
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(lanes >> lane)};
    return hn::LoadMaskBits(Doubles(), bytes);
}

struct Vec3s {
    Vec x;
    Vec y;
    Vec z;
};

HWY_INLINE Vec3s rows(const BlockRows& values, std::size_t lane) {
    return {row(values[0], lane), row(values[1], lane), row(values[2], lane)};
}

HWY_INLINE void store(const Vec3s& value, BlockRows& values, std::size_t lane) {
    store(value.x, values[0], lane);
    store(value.y, values[1], lane);
    store(value.z, values[2], lane);
}

HWY_INLINE Vec3s operator-(const Vec3s& a, const Vec3s& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

HWY_INLINE Vec3s operator*(Vec factor, const Vec3s& a) {
    return {hn::Mul(factor, a.x), hn::Mul(factor, a.y), hn::Mul(factor, a.z)};
}

HWY_INLINE Vec3s operator/(const Vec3s& a, Vec divisor) {
    return {hn::Div(a.x, divisor), hn::Div(a.y, divisor), hn::Div(a.z, divisor)};
}

HWY_INLINE Vec dot(const Vec3s& a, const Vec3s& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

HWY_INLINE Vec largest_component(const Vec3s& a) {
    return hn::Max(hn::Max(hn::Abs(a.x), hn::Abs(a.y)), hn::Abs(a.z));
}

HWY_INLINE Vec3s chosen(Mask mask, const Vec3s& a, const Vec3s& b) {
    return {
        hn::IfThenElse(mask, a.x, b.x),
        hn::IfThenElse(mask, a.y, b.y),
        hn::IfThenElse(mask, a.z, b.z)};
}

/// Whether length() takes the root of the squares' sum as it is. What is not usual is computed lane
/// by lane, by the functions for one place.
HWY_INLINE Mask has_usual_length(Vec largest) {
    return hn::And(hn::Gt(largest, all(1e-140)), hn::Lt(largest, all(1e140)));
}

} // namespace vera::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
