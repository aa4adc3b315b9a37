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
    if (!tree.exact || size_exponent < 1 || size_exponent > 253 || t_exponent < least_t_exponent
        || t_exponent > 253)
        return false;
    const float to_unit = power_of_two(254 - size_exponent);
    const float from_unit = power_of_two(size_exponent);
    const float t_scale = power_of_two(t_exponent);
    per_t_scale = power_of_two(254 - t_exponent);
    bool followed = true;
    float origin_size = 0;
    float direction_size = 0;
    float inverse[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float direction = given.direction[axis] * to_unit + 0;
        const float origin = tree.scale(given.origin[axis]);
        followed = followed && direction * from_unit == given.direction[axis]
            && tree.scale_back(origin) == given.origin[axis];
        ray.origin[axis] = origin;
        ray.direction[axis] = direction;
        inverse[axis] = 1 / std::copysign(std::max(std::abs(direction), 0x1p-60F), direction);
        origin_size = std::max(origin_size, std::abs(origin));
        direction_size += std::abs(direction);
    }
    ray.t_min = given.t_min * t_scale + 0;
    ray.limit = given.t_max * t_scale;
    followed = followed && origin_size <= farthest_origin && ray.t_min >= 0
        && ray.t_min <= ray.limit && ray.t_min * per_t_scale == given.t_min
        && (ray.limit * per_t_scale == given.t_max
            || ray.limit == std::numeric_limits<float>::infinity());
    if (!followed)
        return false;
    ray.direction_size = direction_size * (1 + 0x1p-20F);
    ray.near = std::numeric_limits<float>::infinity();
    ray.place = no_place;
    ray.lane = 0;
    ray.given = &given;
    octant = 0;
    const float slack = rounding_slack(origin_size);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float outward = std::copysign(slack, inverse[axis]);
        ray.inverse[axis] = inverse[axis];
        ray.near_offset[axis] = -(ray.origin[axis] + outward) * inverse[axis];
        ray.far_offset[axis] = -(ray.origin[axis] - outward) * inverse[axis];
        octant |= std::size_t{std::signbit(inverse[axis])} << axis;
    }
    return true;
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
