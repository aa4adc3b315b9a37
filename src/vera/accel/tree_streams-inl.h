// SPDX-License-Identifier: Apache-2.0
// Rays of one octant that go through a tree of boxes together, each tested against boxes by itself.
// Compiled once for each instruction set.

#if defined(VERA_ACCEL_TREE_STREAMS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_TREE_STREAMS_INL_H
#undef VERA_ACCEL_TREE_STREAMS_INL_H
#else
#define VERA_ACCEL_TREE_STREAMS_INL_H
#endif

#include "vera/accel/tree_children-inl.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Rays of a stream, a bit for each.
constexpr std::size_t stream_size = 64;
using StreamMask = std::uint64_t;

/// What waits for rays of a stream.
struct StreamStack {
    TreeChild* children = nullptr; ///< the next one is on top
    StreamMask* rays = nullptr;    ///< for which it waits
    std::uint32_t size = 0;

    void push(const TreeChild& child, StreamMask for_rays) {
        children[size] = child;
        rays[size++] = for_rays;
    }

    /// Takes the next child that waits for some of the rays that are left, and tells for which:
    /// none where there is no such child.
    StreamMask take(StreamMask left, TreeChild& child) {
        while (size > 0) {
            --size;
            const StreamMask taken = rays[size] & left;
            if (taken != 0) {
                child = children[size];
                return taken;
            }
        }
        return 0;
    }
};

#if VERA_AVX512
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

/// A ray as boxes are tested against it. It comes to a plane across an axis, moved outward by the
/// slack, at (plane's place) * inverse + near_offset where it enters the box there, and at the same
/// with far_offset where it leaves. From one axis to the next it is so many numbers as Stride says.
template <std::size_t Stride>
struct BoxedRay {
    const float* inverse;
    const float* near_offset;
    const float* far_offset;
    float limit;
};

/// Which of the rays meet the children of the node before their limits; ray_at(i) is a BoxedRay.
template <std::size_t Stride, typename RayAt>
HWY_INLINE ChildRays rays_of_children(
    const WideNode& node,
    const std::array<std::uint8_t, 6>& places,
    StreamMask rays,
    const RayAt& ray_at) {
    const Children d;
    const float* const planes = node.planes[0].data();
    const auto test = [&](std::size_t i, const auto& take) HWY_ATTR {
        const auto first_x = hn::Load(d, planes + places[0] + i);
        const auto first_y = hn::Load(d, planes + places[1] + i);
        const auto first_z = hn::Load(d, planes + places[2] + i);
        const auto last_x = hn::Load(d, planes + places[3] + i);
        const auto last_y = hn::Load(d, planes + places[4] + i);
        const auto last_z = hn::Load(d, planes + places[5] + i);
        for (StreamMask rest = rays; rest != 0; rest &= rest - 1) {
            const BoxedRay<Stride> ray = ray_at(static_cast<std::size_t>(std::countr_zero(rest)));
            const auto x = hn::Set(d, ray.inverse[0]);
            const auto y = hn::Set(d, ray.inverse[Stride]);
            const auto z = hn::Set(d, ray.inverse[2 * Stride]);
            const auto near = hn::Max(
                hn::Max(
                    hn::MulAdd(first_x, x, hn::Set(d, ray.near_offset[0])),
                    hn::MulAdd(first_y, y, hn::Set(d, ray.near_offset[Stride]))),
                hn::Max(
                    hn::MulAdd(first_z, z, hn::Set(d, ray.near_offset[2 * Stride])), hn::Zero(d)));
            const auto far = hn::Min(
                hn::Min(
                    hn::MulAdd(last_x, x, hn::Set(d, ray.far_offset[0])),
                    hn::MulAdd(last_y, y, hn::Set(d, ray.far_offset[Stride]))),
                hn::Min(
                    hn::MulAdd(last_z, z, hn::Set(d, ray.far_offset[2 * Stride])),
                    hn::Set(d, ray.limit)));
            take(hn::Le(near, far), rest & -rest);
        }
    };
#if VERA_AVX512
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

/// Lets the children of the node wait that rays meet, those to come to first in this order on top.
/// Whole registers are stored.
HWY_INLINE void put_waiting(
    const WideNode& node, const ChildRays& met_rays, std::size_t order, StreamStack& stack) {
#if VERA_AVX512
    const __m512i children = _mm512_load_si512(node.children.data());
    const __m512i numbers = order == any_order
        ? _mm512_set_epi64(0, 1, 2, 3, 4, 5, 6, 7)
        : _mm512_srl_epi64(
            children, _mm_cvtsi32_si128(static_cast<int>(TreeChild::order_shift_of(order))));
    const __m512i children_in_order = _mm512_permutexvar_epi64(numbers, children);
    const __m512i rays_in_order = _mm512_permutexvar_epi64(numbers, met_rays);
    const __mmask8 met = _mm512_test_epi64_mask(rays_in_order, rays_in_order);
    _mm512_storeu_si512(
        stack.children + stack.size, _mm512_maskz_compress_epi64(met, children_in_order));
    _mm512_storeu_si512(stack.rays + stack.size, _mm512_maskz_compress_epi64(met, rays_in_order));
    stack.size += static_cast<std::uint32_t>(std::popcount(std::uint32_t{met}));
#else
    for (std::size_t place = 0; place < tree_width; ++place) {
        const std::size_t child = waiting_at(node, place, order);
        if (met_rays[child] != 0)
            stack.push(node.children[child], met_rays[child]);
    }
#endif
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
