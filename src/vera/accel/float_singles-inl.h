// SPDX-License-Identifier: Apache-2.0
// Rays that are tested by themselves on their way through a tree of boxes: see float_search-inl.h.
// Compiled once for each instruction set.

#if defined(VERA_ACCEL_FLOAT_SINGLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_FLOAT_SINGLES_INL_H
#undef VERA_ACCEL_FLOAT_SINGLES_INL_H
#else
#define VERA_ACCEL_FLOAT_SINGLES_INL_H
#endif

#include "vera/accel/float_rays-inl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A ray that is tested against boxes and elements by itself. See BoxedRay and RayGroup.
struct alignas(64) SingleRay {
    // What boxes need, and most of what elements need, side by side.
    float inverse[3];
    float near_offset[3];
    float far_offset[3];
    float limit;
    float origin[3];
    float direction[3];

    float t_min;
    float near;
    std::uint32_t leaf;
    std::uint32_t place;
    float direction_size;
    float per_square;
    float length;
    std::uint32_t lane;
    RayGroup* group; ///< where it stands among others
    const IndexRay* given;
};

/// The rays of the group, of which those that are not followed may be anything.
HWY_INLINE void write_singles(RayGroup& group, SingleRay* rays) {
    static_assert(offsetof(SingleRay, inverse) == 0);
    static_assert(offsetof(SingleRay, direction) == 13 * sizeof(float));
    const Rays d;
    GroupRow<float> near_offset[3];
    GroupRow<float> far_offset[3];
    const auto slack = hn::Set(d, group.slack);
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
            const auto inverse = hn::Load(d, group.inverse[axis].data() + i);
            const auto origin = hn::Load(d, group.origin[axis].data() + i);
            const auto outward = hn::CopySign(slack, inverse);
            hn::Store(
                hn::Neg(hn::Mul(hn::Add(origin, outward), inverse)),
                d,
                near_offset[axis].data() + i);
            hn::Store(
                hn::Neg(hn::Mul(hn::Sub(origin, outward), inverse)),
                d,
                far_offset[axis].data() + i);
        }
    const std::array<const float*, 16> rows = {
        group.inverse[0].data(),
        group.inverse[1].data(),
        group.inverse[2].data(),
        near_offset[0].data(),
        near_offset[1].data(),
        near_offset[2].data(),
        far_offset[0].data(),
        far_offset[1].data(),
        far_offset[2].data(),
        group.limit.data(),
        group.origin[0].data(),
        group.origin[1].data(),
        group.origin[2].data(),
        group.direction[0].data(),
        group.direction[1].data(),
        group.direction[2].data()};
    for (std::size_t lane = 0; lane < group_size; lane += 4)
        for (std::size_t row = 0; row < rows.size(); row += 4) {
            const auto place_in = [&](std::size_t i) HWY_ATTR {
                return reinterpret_cast<float*>(rays + lane + i) + row;
            };
            transpose(
                {rows[row] + lane,
                 rows[row + 1] + lane,
                 rows[row + 2] + lane,
                 rows[row + 3] + lane},
                {place_in(0), place_in(1), place_in(2), place_in(3)});
        }
    for (std::size_t lane = 0; lane < group_size; ++lane) {
        rays[lane].t_min = group.t_min[lane];
        rays[lane].near = group.near[lane];
        rays[lane].leaf = group.leaf[lane];
        rays[lane].place = group.place[lane];
        rays[lane].direction_size = group.direction_size;
        rays[lane].lane = static_cast<std::uint32_t>(lane);
        rays[lane].group = &group;
        rays[lane].given = &group.rays[std::min(lane, group.rays.size() - 1)];
    }
}

/// Along each axis, the lanes of the group's rays that run backward.
HWY_INLINE std::array<GroupMask, 3> backward_lanes(const RayGroup& group) {
    const Rays d;
    std::array<GroupMask, 3> backward = {};
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t i = 0; i < group_size; i += hn::Lanes(d))
            backward[axis] |=
                bits_of(d, hn::Lt(hn::Load(d, group.inverse[axis].data() + i), hn::Zero(d))) << i;
    return backward;
}

/// The factor 2^(exponent - 127), of an exponent as it stands in a float: from 1 to 254.
inline float power_of_two(int exponent) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(exponent) << 23U);
}

/// Directions of these sizes, by their exponents as they stand in floats, are followed by a ray
/// alone: inverses are computed of what was given, which need not wait for its size. Those of the
/// largest are then usual numbers, and those that are too large for floats are too large to be
/// kept.
constexpr int least_alone_exponent = 64;
constexpr int most_alone_exponent = 252;

/// Fills in a ray that is asked about alone, as place_group() does it; false where single precision
/// cannot follow it. per_t_scale as in a RayGroup.
HWY_INLINE bool start_single(
    const FloatTree& tree,
    const IndexRay& given,
    SingleRay& ray,
    std::size_t& octant,
    float& per_t_scale) {
    const float size = std::max(
        std::abs(given.direction[0]),
        std::max(std::abs(given.direction[1]), std::abs(given.direction[2])));
    const int size_exponent = static_cast<int>(std::bit_cast<std::uint32_t>(size) >> 23U);
    const int t_exponent = size_exponent + tree.exponent;
    if (!tree.exact || size_exponent < least_alone_exponent || size_exponent > most_alone_exponent
        || t_exponent < least_t_exponent || t_exponent > 253)
        return false;
    const float t_scale = power_of_two(t_exponent);
    per_t_scale = power_of_two(254 - t_exponent);
    const float origin_size = tree.scale(std::max(
        std::abs(given.origin[0]), std::max(std::abs(given.origin[1]), std::abs(given.origin[2]))));
    const float t_min = given.t_min * t_scale + 0;
    const float limit = given.t_max * t_scale + 0; // not -0, as boxes are compared by bits
    if (!(origin_size <= farthest_origin && t_min >= 0 && t_min <= limit
          && t_min * per_t_scale == given.t_min
          && (limit * per_t_scale == given.t_max
              || limit == std::numeric_limits<float>::infinity())))
        return false;

    // Registers hold three numbers, and one more that is something, but no matter what: rows are
    // stored in the order in which they stand, and what follows them after them.
    constexpr std::size_t axes = 3;
    const hn::CappedTag<float, 4> d;
    static_assert(offsetof(IndexRay, t_min) == offsetof(IndexRay, origin) + axes * sizeof(float));
    static_assert(
        offsetof(IndexRay, t_max) == offsetof(IndexRay, direction) + axes * sizeof(float));
    static_assert(offsetof(SingleRay, near_offset) == 3 * sizeof(float));
    static_assert(offsetof(SingleRay, far_offset) == 6 * sizeof(float));
    static_assert(offsetof(SingleRay, limit) == 9 * sizeof(float));
    static_assert(offsetof(SingleRay, origin) == 10 * sizeof(float));
    static_assert(offsetof(SingleRay, t_min) == 16 * sizeof(float));
    const auto all = [&](float number) HWY_ATTR { return hn::Set(d, number); };
    // The power of two of the largest coordinate, and its inverse, in each number: the ray's way
    // through the first node waits for them.
    const hn::RebindToUnsigned<decltype(d)> bits;
    const auto power = hn::And(
        hn::BitCast(
            bits,
            hn::Max(
                hn::Abs(all(given.direction[0])),
                hn::Max(hn::Abs(all(given.direction[1])), hn::Abs(all(given.direction[2]))))),
        hn::Set(bits, 0x7f800000U));
    const auto scale_back = hn::BitCast(d, power);
    const auto scale = hn::BitCast(d, hn::Sub(hn::Set(bits, 0x7f000000U), power));
    std::uint32_t exact = 0;
    std::uint32_t backward = 0;
    for (std::size_t i = 0; i < axes; i += hn::Lanes(d)) {
        const auto given_origin = hn::LoadU(d, given.origin.data() + i);
        const auto given_direction = hn::LoadU(d, given.direction.data() + i);
        const auto inverse = hn::CopySign(
            hn::Min(hn::Mul(hn::Abs(hn::Div(all(1), given_direction)), scale_back), all(0x1p60F)),
            given_direction);
        const auto origin =
            hn::Mul(hn::Mul(given_origin, all(tree.scale.first)), all(tree.scale.second));
        // -0 becomes 0.
        const auto direction = hn::Add(hn::Mul(given_direction, scale), hn::Zero(d));
        const auto same_origin = hn::Eq(
            hn::Mul(hn::Mul(origin, all(tree.scale_back.first)), all(tree.scale_back.second)),
            given_origin);
        const auto same_direction = hn::Eq(hn::Mul(direction, scale_back), given_direction);
        exact |= bits_of(d, hn::And(same_origin, same_direction)) << i;
        backward |= bits_of(d, hn::Lt(inverse, hn::Zero(d))) << i;
        // Along each axis as rounding_slack() says it of the largest coordinate.
        const auto inward = hn::CopySign(
            hn::MulAdd(hn::Abs(origin), all(box_rounding), all(least_rounding_slack)),
            hn::Neg(given_direction));
        hn::StoreU(inverse, d, ray.inverse + i);
        hn::StoreU(hn::Mul(hn::Sub(inward, origin), inverse), d, ray.near_offset + i);
        hn::StoreU(hn::Neg(hn::Mul(hn::Add(origin, inward), inverse)), d, ray.far_offset + i);
        hn::StoreU(origin, d, ray.origin + i);
        hn::StoreU(direction, d, ray.direction + i);
    }
    ray.limit = limit;
    ray.t_min = t_min;
    constexpr std::uint32_t all_axes = (1U << axes) - 1;
    if ((exact & all_axes) != all_axes)
        return false;
    octant = backward & all_axes;
    ray.direction_size =
        (std::abs(ray.direction[0]) + std::abs(ray.direction[1]) + std::abs(ray.direction[2]))
        * (1 + 0x1p-20F);
    ray.near = std::numeric_limits<float>::infinity();
    ray.place = no_place;
    ray.lane = 0;
    ray.given = &given;
    return true;
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
