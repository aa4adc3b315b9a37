// SPDX-License-Identifier: Apache-2.0
// Many rays of one octant that go through the tree of a mesh together, each tested against boxes by
// itself: see mesh_search.cpp. Compiled once for each instruction set.

#if defined(VERA_ACCEL_MESH_STREAMS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_MESH_STREAMS_INL_H
#undef VERA_ACCEL_MESH_STREAMS_INL_H
#else
#define VERA_ACCEL_MESH_STREAMS_INL_H
#endif

#include "vera/accel/mesh_singles-inl.h"

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

/// Rays of a stream, a bit for each.
constexpr std::size_t stream_size = 64;
using StreamMask = std::uint64_t;

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
    std::size_t order = 0;              ///< see put_met_children
    std::uint32_t size = 0;             ///< of the stack
    TreeChild* children = nullptr;      ///< what waits; the next one is on top
    StreamMask* waiting = nullptr;      ///< the rays for which it does
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
        const auto numbers = [&](std::size_t ray)
                                 HWY_ATTR { return hn::Load(d, stream.rays[ray]->inverse + i); };
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

#if VERA_COMPRESS_CHILDREN
/// The rays that meet each of the children of a node.
using ChildRays = __m512i;

HWY_INLINE ChildRays all_for(std::uint32_t children, StreamMask rays) {
    return _mm512_maskz_set1_epi64(static_cast<__mmask8>(children), static_cast<long long>(rays));
}
#else
using ChildRays = std::array<StreamMask, tree_width>;

HWY_INLINE ChildRays all_for(std::uint32_t children, StreamMask rays) {
    ChildRays all = {};
    for (; children != 0; children &= children - 1)
        all[static_cast<std::size_t>(std::countr_zero(children))] = rays;
    return all;
}
#endif

/// Which of the rays meet the children of the node before their limits.
HWY_INLINE ChildRays
rays_of_children(const WideNode& node, StreamMask rays, const RayStream& stream) {
    const Children d;
    const float* const planes = node.planes[0].data();
    const auto test = [&](std::size_t i, const auto& take) HWY_ATTR {
        const auto first_x = hn::Load(d, planes + stream.places[0] + i);
        const auto first_y = hn::Load(d, planes + stream.places[1] + i);
        const auto first_z = hn::Load(d, planes + stream.places[2] + i);
        const auto last_x = hn::Load(d, planes + stream.places[3] + i);
        const auto last_y = hn::Load(d, planes + stream.places[4] + i);
        const auto last_z = hn::Load(d, planes + stream.places[5] + i);
        for (StreamMask rest = rays; rest != 0; rest &= rest - 1) {
            const SingleRay& ray = *stream.rays[static_cast<std::size_t>(std::countr_zero(rest))];
            const auto x = hn::Set(d, ray.inverse[0]);
            const auto y = hn::Set(d, ray.inverse[1]);
            const auto z = hn::Set(d, ray.inverse[2]);
            const auto near = hn::Max(
                hn::Max(
                    hn::MulAdd(first_x, x, hn::Set(d, ray.near_offset[0])),
                    hn::MulAdd(first_y, y, hn::Set(d, ray.near_offset[1]))),
                hn::Max(hn::MulAdd(first_z, z, hn::Set(d, ray.near_offset[2])), hn::Zero(d)));
            const auto far = hn::Min(
                hn::Min(
                    hn::MulAdd(last_x, x, hn::Set(d, ray.far_offset[0])),
                    hn::MulAdd(last_y, y, hn::Set(d, ray.far_offset[1]))),
                hn::Min(
                    hn::MulAdd(last_z, z, hn::Set(d, ray.far_offset[2])), hn::Set(d, ray.limit)));
            take(hn::Le(near, far), rest & -rest);
        }
    };
#if VERA_COMPRESS_CHILDREN
    ChildRays met_rays = _mm512_setzero_si512();
    test(0, [&](hn::Mask<Children> met, StreamMask bit) HWY_ATTR {
        met_rays = _mm512_mask_or_epi64(
            met_rays,
            static_cast<__mmask8>(met.raw),
            met_rays,
            _mm512_set1_epi64(static_cast<long long>(bit)));
    });
#else
    ChildRays met_rays = {};
    for (std::size_t i = 0; i < tree_width; i += hn::Lanes(d))
        test(i, [&](hn::Mask<Children> met, StreamMask bit) HWY_ATTR {
            for (std::uint32_t rest = bits_of(d, met); rest != 0; rest &= rest - 1)
                met_rays[i + static_cast<std::size_t>(std::countr_zero(rest))] |= bit;
        });
#endif
    return met_rays;
}

/// Lets the children of the node wait that rays meet, those to come to first on top. Whole
/// registers are stored.
HWY_INLINE void put_waiting(const WideNode& node, ChildRays met_rays, RayStream& stream) {
#if VERA_COMPRESS_CHILDREN
    const __m512i children = _mm512_load_si512(node.children.data());
    const __m512i numbers = _mm512_srl_epi64(
        children, _mm_cvtsi32_si128(static_cast<int>(TreeChild::order_shift_of(stream.order))));
    const __m512i children_in_order = _mm512_permutexvar_epi64(numbers, children);
    const __m512i rays_in_order = _mm512_permutexvar_epi64(numbers, met_rays);
    const __mmask8 met = _mm512_test_epi64_mask(rays_in_order, rays_in_order);
    _mm512_storeu_si512(
        stream.children + stream.size, _mm512_maskz_compress_epi64(met, children_in_order));
    _mm512_storeu_si512(
        stream.waiting + stream.size, _mm512_maskz_compress_epi64(met, rays_in_order));
    stream.size += static_cast<std::uint32_t>(std::popcount(std::uint32_t{met}));
#else
    for (std::size_t place = 0; place < tree_width; ++place) {
        const std::size_t child = node.children[place].in_order(stream.order);
        if (met_rays[child] == 0)
            continue;
        stream.children[stream.size] = node.children[child];
        stream.waiting[stream.size++] = met_rays[child];
    }
#endif
}

/// Lets the children of the node wait that the rays meet before their limits.
template <bool any>
HWY_INLINE void put_met_children(const WideNode& node, StreamMask rays, RayStream& stream) {
    if constexpr (any)
        if (HWY_UNLIKELY(stream.patience > 0) && std::popcount(rays) >= bounded_rays) {
            const BoundedChildren children = bounded_children(node, stream);
            if (children.may == children.sure) {
                put_waiting(node, all_for(children.sure, rays), stream);
                return;
            }
            --stream.patience;
        }
    put_waiting(node, rays_of_children(node, rays, stream), stream);
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
