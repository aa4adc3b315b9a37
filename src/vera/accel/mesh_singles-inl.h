// SPDX-License-Identifier: Apache-2.0
// Rays that go through the tree of a mesh alone: see mesh_search.cpp. Compiled once for each
// instruction set.

#if defined(VERA_ACCEL_MESH_SINGLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_MESH_SINGLES_INL_H
#undef VERA_ACCEL_MESH_SINGLES_INL_H
#else
#define VERA_ACCEL_MESH_SINGLES_INL_H
#endif

#include "vera/accel/mesh_rays-inl.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A ray that goes through the tree alone.
struct alignas(64) RayWalk {
    Walk walk;
    float origin[3];
    float direction[3];
    float direction_size = 0; ///< this and the next: see RayGroup
    float blur = 0;
    float t_min = 0;
    float limit = 0;
    float near = 0;
    std::uint32_t leaf = 0;
    std::uint32_t place = no_place;
    std::uint32_t lane = 0;
    RayGroup* group = nullptr; ///< where it stands among others
    const MeshRay* given = nullptr;
};

/// Lets the ray begin at the root, or where it is left.
HWY_INLINE void
start_walk(const float* inverse, float slack, bool any, TreeChild* stack, RayWalk& ray) {
    std::size_t octant = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float outward = std::copysign(slack, inverse[axis]);
        ray.walk.inverse[axis] = inverse[axis];
        ray.walk.near_offset[axis] = -(ray.origin[axis] + outward) * inverse[axis];
        ray.walk.far_offset[axis] = -(ray.origin[axis] - outward) * inverse[axis];
        octant |= std::size_t{std::signbit(inverse[axis])} << axis;
    }
    ray.walk.places = plane_places[octant];
    ray.walk.order = static_cast<std::uint8_t>(any ? any_order : octant);
    ray.walk.size = 0;
    ray.walk.stack = stack;
    ray.place = no_place;
}

HWY_INLINE void
start_alone(RayGroup& group, std::size_t lane, bool any, TreeChild* stack, RayWalk& ray) {
    float inverse[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        ray.origin[axis] = group.origin[axis][lane];
        ray.direction[axis] = group.direction[axis][lane];
        inverse[axis] = group.inverse[axis][lane];
    }
    ray.direction_size = group.direction_size;
    ray.blur = group.blur;
    ray.t_min = group.t_min[lane];
    ray.limit = group.limit[lane];
    ray.near = group.near[lane];
    ray.lane = static_cast<std::uint32_t>(lane);
    ray.group = &group;
    ray.given = &group.rays[lane];
    start_walk(inverse, group.slack, any, stack, ray);
}

/// The factor 2^(exponent - 127), of an exponent as it stands in a float: from 1 to 254.
inline float power_of_two(int exponent) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(exponent) << 23U);
}

/// The same for one ray that is asked about alone, as place_group() does it; false where single
/// precision cannot follow it. per_t_scale as in a RayGroup.
HWY_INLINE bool start_single(
    const MeshTree& tree,
    const MeshRay& given,
    bool any,
    TreeChild* stack,
    RayWalk& ray,
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
    ray.blur = 0;
    ray.near = std::numeric_limits<float>::infinity();
    ray.lane = 0;
    ray.given = &given;
    start_walk(inverse, 0x1p-20F * (1 + origin_size), any, stack, ray);
    return true;
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
