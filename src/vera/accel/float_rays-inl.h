// SPDX-License-Identifier: Apache-2.0
// Rays as they go through a tree of boxes: see float_search-inl.h. Compiled once for each
// instruction set.

#if defined(VERA_ACCEL_FLOAT_RAYS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_FLOAT_RAYS_INL_H
#undef VERA_ACCEL_FLOAT_RAYS_INL_H
#else
#define VERA_ACCEL_FLOAT_RAYS_INL_H
#endif

#include "vera/accel/float_tree.h"
#include "vera/accel/tree_children-inl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Rays that follow each other, and may go through the tree together.
constexpr std::size_t group_size = 16;
using GroupMask = std::uint32_t;

using Rays = hn::CappedTag<float, group_size>;
using RayInts = hn::RebindToSigned<Rays>;

template <typename Number>
struct alignas(64) GroupRow : std::array<Number, group_size> {};

/// A group of rays, coordinate by coordinate, as single precision follows them: in the coordinates
/// of the tree, with directions of which the largest coordinate lies between 1 and 2. There t is
/// t_scale times what it is outside. All of these are powers of two times what was given, exactly.
struct RayGroup {
    GroupRow<float> origin[3];
    GroupRow<float> direction[3];
    GroupRow<float> t_min;
    GroupRow<float> per_t_scale; ///< 1 / t_scale
    GroupRow<float> inverse[3];  ///< of the direction; large but finite where that is 0
    GroupRow<float> largest;     ///< the direction's largest coordinate, without its sign
    // Only for spheres:
    GroupRow<float> per_square; ///< 1 / the square of the direction's length
    GroupRow<float> length;     ///< at least that length, and hardly more
    GroupRow<float> limit;      ///< what lies behind this t does not count any more
    /// Of what is surely met and nearest so far: a t before which it is not; and where it stands.
    GroupRow<float> near;
    GroupRow<std::uint32_t> leaf;     ///< TreeChild::first() of its leaf
    GroupRow<std::uint32_t> place;    ///< in the leaf: see place_in_leaf()
    GroupRow<std::uint32_t> doubtful; ///< the last of the lane's Doubtful
    GroupMask in_doubt = 0;           ///< the lanes that have one
    std::span<const IndexRay> rays;
    GroupMask followed = 0;   ///< the lanes of rays that single precision can follow
    GroupMask met = 0;        ///< where only this is asked: the lanes that surely meet something
    float direction_size = 0; ///< the largest sum of a direction's coordinates, without signs
    float slack = 0;          ///< how far boxes are enlarged for what is rounded
};

/// No place in a leaf.
constexpr std::uint32_t no_place = ~std::uint32_t{0};

/// Where element i of a leaf of that size stands.
inline std::uint32_t place_in_leaf(std::size_t size, std::size_t i) {
    return static_cast<std::uint32_t>(size << 8U | i);
}

HWY_INLINE hn::Mask<Rays> in_group(Rays d, GroupMask set, std::size_t first) {
#if VERA_AVX512
    return {static_cast<__mmask16>(set >> first)};
#else
    const std::uint8_t bytes[8] = {
        static_cast<std::uint8_t>(set >> first), static_cast<std::uint8_t>(set >> first >> 8U)};
    return hn::LoadMaskBits(d, bytes);
#endif
}

/// Rays that go to more than so many times the elements' extent away from it are followed in double
/// precision: single precision does not tell much of them.
constexpr float farthest_origin = 0x1p10F;

/// Of t_scale, as it stands in a float. Where what is farthest away is met, t is below 2^121 then:
/// not more than floats can hold.
constexpr int least_t_exponent = 17;

/// 2^(exponents - 127), for exponents as they stand in a float: from 1 to 254.
HWY_INLINE hn::Vec<Rays> power_of_two(hn::Vec<RayInts> exponents) {
    return hn::BitCast(Rays(), hn::ShiftLeft<23>(exponents));
}

/// An inverse that is not infinite stands for directions of less than 2^-60, by which rays move
/// less than 2^-49 on the way to any element.
constexpr float least_rounding_slack = 0x1p-44F;

/// How far boxes are enlarged, beside what stands in the tree, where no coordinate of an origin is
/// larger.
inline float rounding_slack(float largest_origin) {
    return box_rounding * largest_origin + least_rounding_slack;
}

/// Rays as they were given, in the lanes of registers: the origin and t_min, the direction and
/// t_max.
struct GivenRays {
    hn::Vec<Rays> origin[4];
    hn::Vec<Rays> direction[4];
};

#if HWY_TARGET != HWY_SCALAR
/// Of every fourth ray the four numbers that begin there, where the first one's do.
template <typename D>
HWY_INLINE hn::Vec<D> every_fourth(D d, const float* first) {
    if constexpr (hn::MaxLanes(D()) <= 4) {
        return hn::LoadU(d, first);
    } else {
        constexpr std::size_t numbers = sizeof(IndexRay) / sizeof(float);
        const hn::Half<D> half;
        return hn::Combine(
            d, every_fourth(half, first + hn::MaxLanes(half) * numbers), every_fourth(half, first));
    }
}
#endif

/// The four numbers that begin at number place of each ray. They stay in registers, as wide loads
/// would wait for what narrow stores wrote.
HWY_INLINE void
load_numbers(Rays d, const IndexRay* rays, std::size_t place, hn::Vec<Rays> (&numbers)[4]) {
    const float* const first = rays->origin.data() + place;
#if HWY_TARGET == HWY_SCALAR
    for (std::size_t i = 0; i < 4; ++i)
        numbers[i] = hn::Load(d, first + i);
#else
    constexpr std::size_t next = sizeof(IndexRay) / sizeof(float);
    const auto a = every_fourth(d, first);
    const auto b = every_fourth(d, first + next);
    const auto c = every_fourth(d, first + 2 * next);
    const auto e = every_fourth(d, first + 3 * next);
    const auto ac = hn::InterleaveLower(d, a, c);
    const auto be = hn::InterleaveLower(d, b, e);
    const auto upper_ac = hn::InterleaveUpper(d, a, c);
    const auto upper_be = hn::InterleaveUpper(d, b, e);
    numbers[0] = hn::InterleaveLower(d, ac, be);
    numbers[1] = hn::InterleaveUpper(d, ac, be);
    numbers[2] = hn::InterleaveLower(d, upper_ac, upper_be);
    numbers[3] = hn::InterleaveUpper(d, upper_ac, upper_be);
#endif
}

/// A register full of rays.
HWY_INLINE GivenRays given_rays(Rays d, const IndexRay* rays) {
    static_assert(offsetof(IndexRay, t_min) == 3 * sizeof(float));
    static_assert(offsetof(IndexRay, direction) == 4 * sizeof(float));
    static_assert(offsetof(IndexRay, t_max) == 7 * sizeof(float));
    GivenRays given;
    load_numbers(d, rays, 0, given.origin);
    load_numbers(d, rays, 4, given.direction);
    return given;
}

/// Fills in the rows of the group of these group_size rays, of which those of the lanes are to be
/// followed.
HWY_INLINE void
place_group(const FloatTree& tree, const IndexRay* rays, GroupMask lanes, RayGroup& group) {
    const Rays d;
    const RayInts di;
    const auto first = hn::Set(d, tree.scale.first);
    const auto second = hn::Set(d, tree.scale.second);
    const auto back_first = hn::Set(d, tree.scale_back.first);
    const auto back_second = hn::Set(d, tree.scale_back.second);
    const auto exponent = hn::Set(di, tree.exponent);
    const auto infinite = hn::Set(d, std::numeric_limits<float>::infinity());
    auto largest_origin = hn::Zero(d);
    auto largest_direction = hn::Zero(d);
    group.followed = 0;
    group.met = 0;
    group.in_doubt = 0;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
        const GivenRays all_given = given_rays(d, rays + i);
        auto followed = in_group(d, lanes, i);
        auto size = hn::Zero(d);
        for (std::size_t axis = 0; axis < 3; ++axis)
            size = hn::Max(size, hn::Abs(all_given.direction[axis]));
        const auto size_exponent = hn::ShiftRight<23>(hn::BitCast(di, size));
        const auto t_exponent = hn::Add(size_exponent, exponent);
        const auto usual = hn::And(
            hn::And(hn::Gt(size_exponent, hn::Zero(di)), hn::Lt(size_exponent, hn::Set(di, 254))),
            hn::And(
                hn::Gt(t_exponent, hn::Set(di, least_t_exponent - 1)),
                hn::Lt(t_exponent, hn::Set(di, 254))));
        followed = hn::And(followed, hn::RebindMask(d, usual));

        const auto to_unit = power_of_two(hn::Sub(hn::Set(di, 254), size_exponent));
        const auto from_unit = power_of_two(size_exponent);
        auto origin_size = hn::Zero(d);
        auto direction_size = hn::Zero(d);
        auto largest = hn::Zero(d);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto given = all_given.direction[axis];
            // -0 becomes 0.
            const auto direction = hn::Add(hn::Mul(given, to_unit), hn::Zero(d));
            followed = hn::And(followed, hn::Eq(hn::Mul(direction, from_unit), given));
            hn::Store(direction, d, group.direction[axis].data() + i);
            largest = hn::Max(largest, hn::Abs(direction));
            direction_size = hn::Add(direction_size, hn::Abs(direction));
            hn::Store(
                hn::Div(
                    hn::Set(d, 1),
                    hn::CopySign(hn::Max(hn::Abs(direction), hn::Set(d, 0x1p-60F)), direction)),
                d,
                group.inverse[axis].data() + i);
            const auto given_origin = all_given.origin[axis];
            const auto origin = hn::Mul(hn::Mul(given_origin, first), second);
            followed = hn::And(
                followed, hn::Eq(hn::Mul(hn::Mul(origin, back_first), back_second), given_origin));
            hn::Store(origin, d, group.origin[axis].data() + i);
            origin_size = hn::Max(origin_size, hn::Abs(origin));
        }
        followed = hn::And(followed, hn::Le(origin_size, hn::Set(d, farthest_origin)));

        const auto t_scale = power_of_two(t_exponent);
        const auto per_t_scale = power_of_two(hn::Sub(hn::Set(di, 254), t_exponent));
        const auto given_min = all_given.origin[3];
        const auto given_max = all_given.direction[3];
        // -0 becomes 0.
        const auto t_min = hn::Add(hn::Mul(given_min, t_scale), hn::Zero(d));
        const auto t_max = hn::Mul(given_max, t_scale);
        followed = hn::And(
            followed,
            hn::And(
                hn::And(hn::Ge(t_min, hn::Zero(d)), hn::Le(t_min, t_max)),
                hn::And(
                    hn::Eq(hn::Mul(t_min, per_t_scale), given_min),
                    hn::Or(
                        hn::Eq(hn::Mul(t_max, per_t_scale), given_max), hn::Eq(t_max, infinite)))));
        hn::Store(t_min, d, group.t_min.data() + i);
        hn::Store(per_t_scale, d, group.per_t_scale.data() + i);
        hn::Store(hn::IfThenElse(followed, t_max, hn::Set(d, -1)), d, group.limit.data() + i);
        hn::Store(infinite, d, group.near.data() + i);
        hn::Store(
            hn::Set(hn::RebindToUnsigned<Rays>(), no_place),
            hn::RebindToUnsigned<Rays>(),
            group.place.data() + i);
        // Those of other rays may be no numbers.
        hn::Store(hn::IfThenElse(followed, largest, hn::Set(d, 1)), d, group.largest.data() + i);
        group.followed |= bits_of(d, followed) << i;
        largest_origin = hn::Max(largest_origin, hn::IfThenElseZero(followed, origin_size));
        largest_direction =
            hn::Max(largest_direction, hn::IfThenElseZero(followed, direction_size));
    }
    group.direction_size = hn::GetLane(hn::MaxOfLanes(d, largest_direction)) * (1 + 0x1p-20F);
    group.slack = rounding_slack(hn::GetLane(hn::MaxOfLanes(d, largest_origin)));
}

/// Writes four times four numbers column by column: number i of from[j] becomes number j of to[i].
HWY_INLINE void
transpose(const std::array<const float*, 4>& from, const std::array<float*, 4>& to) {
#if HWY_TARGET == HWY_SCALAR
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            to[i][j] = from[j][i];
#else
    const hn::FixedTag<float, 4> d;
    const auto a = hn::LoadU(d, from[0]);
    const auto b = hn::LoadU(d, from[1]);
    const auto c = hn::LoadU(d, from[2]);
    const auto e = hn::LoadU(d, from[3]);
    const auto ac = hn::InterleaveLower(d, a, c);
    const auto be = hn::InterleaveLower(d, b, e);
    const auto upper_ac = hn::InterleaveUpper(d, a, c);
    const auto upper_be = hn::InterleaveUpper(d, b, e);
    hn::StoreU(hn::InterleaveLower(d, ac, be), d, to[0]);
    hn::StoreU(hn::InterleaveUpper(d, ac, be), d, to[1]);
    hn::StoreU(hn::InterleaveLower(d, upper_ac, upper_be), d, to[2]);
    hn::StoreU(hn::InterleaveUpper(d, upper_ac, upper_be), d, to[3]);
#endif
}

/// Makes a group of up to group_size rays.
HWY_INLINE void
start_group(const FloatTree& tree, std::span<const IndexRay> rays, RayGroup& group) {
    group.rays = rays;
    // Where numbers lost digits, what is sure in single precision is sure of other elements.
    const GroupMask lanes = tree.exact ? (GroupMask{1} << rays.size()) - 1 : 0;
    if (HWY_LIKELY(rays.size() == group_size)) {
        place_group(tree, rays.data(), lanes, group);
        return;
    }
    // What is missing is a copy of the last.
    std::array<IndexRay, group_size> copies;
    for (std::size_t lane = 0; lane < group_size; ++lane)
        copies[lane] = rays[std::min(lane, rays.size() - 1)];
    place_group(tree, copies.data(), lanes, group);
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
