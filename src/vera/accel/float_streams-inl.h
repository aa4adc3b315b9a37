// SPDX-License-Identifier: Apache-2.0
// Many rays of one octant that go through a tree of boxes together, each tested against boxes by
// itself: see float_search-inl.h. Compiled once for each instruction set.

#if defined(VERA_ACCEL_FLOAT_STREAMS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_FLOAT_STREAMS_INL_H
#undef VERA_ACCEL_FLOAT_STREAMS_INL_H
#else
#define VERA_ACCEL_FLOAT_STREAMS_INL_H
#endif

#include "vera/accel/float_singles-inl.h"
#include "vera/accel/tree_streams-inl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Bounds of where rays of one octant come to planes: along an axis, none comes to a plane earlier
/// than the earlier of two lines in its place does, nor later than the later of two others.
struct StreamBounds {
    struct Axis {
        float inverse[2];
        float earliest_near[2];
        float latest_near[2];
        float earliest_far[2];
        float latest_far[2];
    };

    Axis axes[3];
    float least_limit = 0;
    float largest_limit = 0;
};

/// Rays of one octant that go through the tree together, each tested against boxes by itself.
struct RayStream {
    std::array<SingleRay*, stream_size> rays;
    std::size_t count = 0;              ///< of the rays
    StreamMask left = 0;                ///< the rays whose search goes on
    std::array<std::uint8_t, 6> places; ///< see plane_places
    std::size_t order = 0;              ///< see put_waiting
    StreamStack stack;
    /// How often bounds of all rays may fail to tell which children they meet, until they are not
    /// asked any more.
    int patience = 0;
    StreamBounds bounds;
};

/// Of fewer rays, it takes less to test each than to ask their bounds first.
constexpr int bounded_rays = 12;

/// Whether the rays are many, and some of them run nearly in the same direction.
HWY_INLINE bool run_alike(const RayStream& stream) {
    constexpr float most_apart = 0.125F;
    if (stream.count < bounded_rays)
        return false;
    const float* const first = stream.rays[0]->direction;
    const float* const middle = stream.rays[stream.count / 2]->direction;
    const float* const last = stream.rays[stream.count - 1]->direction;
    float apart = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        apart = std::max(
            {apart, std::abs(first[axis] - middle[axis]), std::abs(first[axis] - last[axis])});
    return apart < most_apart;
}

/// Fills in the bounds of the stream's rays.
HWY_NOINLINE inline void bound_rays(std::size_t octant, RayStream& stream) {
    constexpr std::size_t bounded = 16; // numbers of a SingleRay
    static_assert(offsetof(SingleRay, t_min) == bounded * sizeof(float));
    const hn::CappedTag<float, bounded> d;
    alignas(64) float least[bounded];
    alignas(64) float most[bounded];
    for (std::size_t i = 0; i < bounded; i += hn::Lanes(d)) {
        const auto numbers = [&](std::size_t ray) HWY_ATTR {
            return hn::Load(d, reinterpret_cast<const float*>(stream.rays[ray]) + i);
        };
        auto low = numbers(0);
        auto high = low;
        for (std::size_t ray = 1; ray < stream.count; ++ray) {
            low = hn::Min(low, numbers(ray));
            high = hn::Max(high, numbers(ray));
        }
        hn::Store(low, d, least + i);
        hn::Store(high, d, most + i);
    }
    constexpr std::size_t limit = offsetof(SingleRay, limit) / sizeof(float);
    constexpr std::size_t origin = offsetof(SingleRay, origin) / sizeof(float);
    float slack = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        slack = std::max(
            slack, std::max(std::abs(least[origin + axis]), std::abs(most[origin + axis])));
    slack = rounding_slack(slack);
    stream.patience = 8;
    stream.bounds.least_limit = least[limit];
    stream.bounds.largest_limit = most[limit];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool backward = (octant >> axis & 1U) != 0;
        const float outward = backward ? -slack : slack;
        const float early = backward ? least[origin + axis] : most[origin + axis];
        const float late = backward ? most[origin + axis] : least[origin + axis];
        StreamBounds::Axis& bounds = stream.bounds.axes[axis];
        bounds.inverse[0] = least[axis];
        bounds.inverse[1] = most[axis];
        for (std::size_t i = 0; i < 2; ++i) {
            bounds.earliest_near[i] = -(early + outward) * bounds.inverse[i];
            bounds.latest_near[i] = -(late + outward) * bounds.inverse[i];
            bounds.earliest_far[i] = -(early - outward) * bounds.inverse[i];
            bounds.latest_far[i] = -(late - outward) * bounds.inverse[i];
        }
    }
}

/// Which children of the node rays of the stream may meet, and which all of them surely do.
struct BoundedChildren {
    std::uint32_t may = 0;
    std::uint32_t sure = 0;
};

HWY_NOINLINE inline BoundedChildren
bounded_children(const WideNode& node, const RayStream& stream) {
    const Children d;
    using V = hn::Vec<Children>;
    const float* const planes = node.planes[0].data();
    BoundedChildren children;
    for (std::size_t i = 0; i < tree_width; i += hn::Lanes(d)) {
        V earliest_near = hn::Zero(d);
        V latest_near = hn::Zero(d);
        V earliest_far = hn::Set(d, stream.bounds.least_limit);
        V latest_far = hn::Set(d, stream.bounds.largest_limit);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const StreamBounds::Axis& bounds = stream.bounds.axes[axis];
            const V first = hn::Load(d, planes + stream.places[axis] + i);
            const V last = hn::Load(d, planes + stream.places[3 + axis] + i);
            const V inverse_0 = hn::Set(d, bounds.inverse[0]);
            const V inverse_1 = hn::Set(d, bounds.inverse[1]);
            const auto line = [&](V plane, const float* offsets, std::size_t j) HWY_ATTR {
                return hn::MulAdd(plane, j == 0 ? inverse_0 : inverse_1, hn::Set(d, offsets[j]));
            };
            const auto earlier = [&](V plane, const float* offsets) HWY_ATTR {
                return hn::Min(line(plane, offsets, 0), line(plane, offsets, 1));
            };
            const auto later = [&](V plane, const float* offsets) HWY_ATTR {
                return hn::Max(line(plane, offsets, 0), line(plane, offsets, 1));
            };
            earliest_near = hn::Max(earliest_near, earlier(first, bounds.earliest_near));
            latest_near = hn::Max(latest_near, later(first, bounds.latest_near));
            earliest_far = hn::Min(earliest_far, earlier(last, bounds.earliest_far));
            latest_far = hn::Min(latest_far, later(last, bounds.latest_far));
        }
        children.may |= bits_of(d, hn::Le(earliest_near, latest_far)) << i;
        children.sure |= bits_of(d, hn::Le(latest_near, earliest_far)) << i;
    }
    return children;
}

/// Lets the children of the node wait that the rays meet before their limits.
template <bool any>
HWY_INLINE void put_met_children(const WideNode& node, StreamMask rays, RayStream& stream) {
    if constexpr (any)
        if (HWY_UNLIKELY(stream.patience > 0) && std::popcount(rays) >= bounded_rays) {
            const BoundedChildren children = bounded_children(node, stream);
            if (children.may == children.sure) {
                put_waiting(node, all_for(children.sure, rays), stream.order, stream.stack);
                return;
            }
            --stream.patience;
        }
    const auto ray_at = [&](std::size_t i) {
        const SingleRay& ray = *stream.rays[i];
        return BoxedRay<1>{ray.inverse, ray.near_offset, ray.far_offset, ray.limit};
    };
    put_waiting(
        node, rays_of_children<1>(node, stream.places, rays, ray_at), stream.order, stream.stack);
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
