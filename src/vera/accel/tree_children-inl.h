// SPDX-License-Identifier: Apache-2.0
// How rays come to the children of a node of a tree of boxes. Compiled once for each instruction
// set.

#if defined(VERA_ACCEL_TREE_CHILDREN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_TREE_CHILDREN_INL_H
#undef VERA_ACCEL_TREE_CHILDREN_INL_H
#else
#define VERA_ACCEL_TREE_CHILDREN_INL_H
#endif

#include "vera/accel/tree_structures.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Children of a node that a ray is tested against together.
using Children = hn::CappedTag<float, tree_width>;

#undef VERA_AVX512
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
#define VERA_AVX512 1
#else
#define VERA_AVX512 0
#endif

template <typename D>
HWY_INLINE std::uint32_t bits_of(D d, hn::Mask<D> mask) {
#if VERA_AVX512
    if constexpr (sizeof(mask.raw) <= sizeof(std::uint16_t))
        return static_cast<std::uint32_t>(mask.raw) & ((std::uint32_t{1} << hn::Lanes(d)) - 1);
#endif
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    const std::uint32_t all = bytes[0] | std::uint32_t{bytes[1]} << 8U;
    return all & ((std::uint32_t{1} << hn::Lanes(d)) - 1);
}

/// Where the planes are, in a node, that rays of each octant come to first and last along each
/// axis: in numbers from the first plane on.
constexpr auto plane_places = [] {
    std::array<std::array<std::uint8_t, 6>, octant_count> places = {};
    for (std::size_t octant = 0; octant < octant_count; ++octant)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool backward = (octant >> axis & 1U) != 0;
            places[octant][axis] =
                static_cast<std::uint8_t>((backward ? axis + 3 : axis) * tree_width);
            places[octant][3 + axis] =
                static_cast<std::uint8_t>((backward ? axis : axis + 3) * tree_width);
        }
    return places;
}();

/// What foreseen() takes at most.
constexpr std::size_t most_foreseen = tree_width + 1;

/// The number by a jump that the processor foresees, no more by what it was computed from. What is
/// loaded from a place of that number is then loaded before it is known, and once more where
/// another was foreseen: the way from node to node is not as long as the sum of all that is
/// computed at each.
HWY_INLINE std::size_t foreseen(std::size_t number) {
    const auto here = [](std::size_t same) HWY_ATTR {
#if HWY_COMPILER_GCC || HWY_COMPILER_CLANG
        asm("" : "+r"(same)); // or compilers see that it is the number, and do not jump
#endif
        return same;
    };
    static_assert(most_foreseen == 9);
    switch (number) {
    case 0:
        return here(0);
    case 1:
        return here(1);
    case 2:
        return here(2);
    case 3:
        return here(3);
    case 4:
        return here(4);
    case 5:
        return here(5);
    case 6:
        return here(6);
    case 7:
        return here(7);
    case 8:
        return here(8);
    default:
        return here(9);
    }
}

/// Children that were put onto a stack.
struct PutChildren {
    std::uint32_t count = 0;
    std::size_t first = 0; ///< the number of the one on top, where there is any
};

/// Puts the children of the node onto a stack for which near, which is not negative, is not behind
/// far, those to come to first in this order, or where that is cheaper, the nearest ones, on top.
/// near_at(i) and far_at(i) are those of a register full of children from number i on. Whole
/// registers are stored.
template <typename NearAt, typename FarAt>
HWY_INLINE PutChildren put_met_children(
    const WideNode& node,
    [[maybe_unused]] std::size_t order,
    const NearAt& near_at,
    const FarAt& far_at,
    TreeChild* stack) {
#if VERA_AVX512
    const __m512i children = _mm512_load_si512(node.children.data());
    const __m512i numbers = _mm512_srl_epi64(
        children, _mm_cvtsi32_si128(static_cast<int>(TreeChild::order_shift_of(order))));
    const __m256i short_numbers = _mm512_cvtepi64_epi32(numbers);
    const __m512i in_order = _mm512_permutexvar_epi64(numbers, children);
    const __m256 near = _mm256_permutevar8x32_ps(near_at(0).raw, short_numbers);
    const __m256 far = _mm256_permutevar8x32_ps(far_at(0).raw, short_numbers);
    const __mmask8 met = _mm256_cmp_ps_mask(near, far, _CMP_LE_OQ);
    const __m512i upper = _mm512_slli_epi64(_mm512_cvtepu32_epi64(_mm256_castps_si256(near)), 32);
    // Bit by bit, of the child where lower_part has a one, of upper where it has none.
    const __m512i waiting = _mm512_ternarylogic_epi64(
        _mm512_set1_epi64(static_cast<long long>(TreeChild::lower_part)), in_order, upper, 0xca);
    _mm512_storeu_si512(stack, _mm512_maskz_compress_epi64(met, waiting));
    const std::uint32_t bits = met;
    const std::size_t last = static_cast<std::size_t>(std::bit_width(bits) - 1) % tree_width;
    return {static_cast<std::uint32_t>(std::popcount(bits)), node.children[last].in_order(order)};
#else
    const Children d;
    std::uint32_t met = 0;
    alignas(64) float near[tree_width];
    for (std::size_t i = 0; i < tree_width; i += hn::Lanes(d)) {
        const auto enters = near_at(i);
        hn::StoreU(enters, d, near + i);
        met |= bits_of(d, hn::Le(enters, far_at(i))) << i;
    }
    std::uint32_t size = 0;
    std::size_t first = 0;
    for (; met != 0; met &= met - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(met));
        const TreeChild child = TreeChild::waiting(node.children[i], near[i]);
        std::size_t place = size++;
        for (; place > 0 && stack[place - 1].bits < child.bits; --place)
            stack[place] = stack[place - 1];
        stack[place] = child;
        if (place + 1 == size)
            first = i;
    }
    return {size, first};
#endif
}

/// The same for rays that come to children by their numbers, without where they are entered;
/// returns how many are met.
template <typename NearAt, typename FarAt>
HWY_INLINE std::uint32_t put_any_children(
    const WideNode& node, const NearAt& near_at, const FarAt& far_at, TreeChild* stack) {
#if VERA_AVX512
    const __m256i last_first = _mm256_setr_epi32(7, 6, 5, 4, 3, 2, 1, 0);
    const __mmask8 met = _mm256_cmp_ps_mask(
        _mm256_permutevar8x32_ps(near_at(0).raw, last_first),
        _mm256_permutevar8x32_ps(far_at(0).raw, last_first),
        _CMP_LE_OQ);
    const __m512i children = _mm512_permutexvar_epi64(
        _mm512_cvtepi32_epi64(last_first), _mm512_load_si512(node.children.data()));
    _mm512_storeu_si512(stack, _mm512_maskz_compress_epi64(met, children));
    return static_cast<std::uint32_t>(std::popcount(static_cast<std::uint32_t>(met)));
#else
    const Children d;
    std::uint32_t met = 0;
    for (std::size_t i = 0; i < tree_width; i += hn::Lanes(d))
        met |= bits_of(d, hn::Le(near_at(i), far_at(i))) << i;
    const auto size = static_cast<std::uint32_t>(std::popcount(met));
    for (TreeChild* place = stack + size; met != 0; met &= met - 1)
        *--place = node.children[static_cast<std::size_t>(std::countr_zero(met))];
    return size;
#endif
}

/// Drops what waits behind the limit, which is at least 0, of a stack of this size; returns how
/// much is left. Whole registers are stored.
HWY_INLINE std::uint32_t drop_behind(TreeChild* stack, std::uint32_t size, float limit) {
    // As integers, numbers that are not negative have the same order.
    const std::uint64_t last = TreeChild::waiting({~std::uint64_t{0}}, limit).bits;
    std::uint32_t kept = 0;
#if VERA_AVX512
    for (std::uint32_t i = 0; i < size; i += tree_width) {
        const __m512i children = _mm512_loadu_si512(stack + i);
        const std::uint32_t there = size - i < tree_width ? (1U << (size - i)) - 1 : 0xffU;
        const auto before = static_cast<__mmask8>(
            there
            & _mm512_cmple_epu64_mask(children, _mm512_set1_epi64(static_cast<long long>(last))));
        _mm512_storeu_si512(stack + kept, _mm512_maskz_compress_epi64(before, children));
        kept += static_cast<std::uint32_t>(std::popcount(static_cast<std::uint32_t>(before)));
    }
#else
    for (std::uint32_t i = 0; i < size; ++i)
        if (stack[i].bits <= last)
            stack[kept++] = stack[i];
#endif
    return kept;
}

/// Lets the processor fetch what the child is: one of the nodes, or a block that begins so many
/// units of bytes behind the blocks.
HWY_INLINE void
fetch(const WideNode* nodes, const void* blocks, std::size_t unit, const TreeChild& child) {
    // Without a branch, which would be guessed wrongly again and again.
    const auto* const base = static_cast<const char*>(blocks);
    const std::uintptr_t to_nodes =
        reinterpret_cast<std::uintptr_t>(nodes) - reinterpret_cast<std::uintptr_t>(blocks);
    const std::uintptr_t first = child.first();
    const std::uintptr_t if_node = std::uintptr_t{child.is_block()} - 1;
    const char* const place =
        base
        + static_cast<std::ptrdiff_t>(
            first * unit + (if_node & (to_nodes + first * (sizeof(WideNode) - unit))));
    for (std::size_t line = 0; line < sizeof(WideNode); line += 128)
        hwy::Prefetch(place + line);
}

/// What waits for one ray, or for a packet, in a tree of so many levels is at most this much: at
/// each level less than a node's children; and whole registers are stored.
constexpr std::size_t waiting_depth(std::size_t levels) {
    return tree_width * (levels + 2);
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
