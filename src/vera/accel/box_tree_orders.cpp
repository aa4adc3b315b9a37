// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/box_tree_nodes.h"

#include <array>
#include <cstdint>
#include <iterator>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vera/accel/box_tree_orders.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Octants side by side.
using Octants = hn::CappedTag<float, octant_count>;
using Bits = hn::RebindToUnsigned<Octants>;

/// Puts the larger of the two first.
template <typename V>
HWY_INLINE void put_in_order(V& first, V& second) {
    const V larger = hn::Max(first, second);
    second = hn::Min(first, second);
    first = larger;
}

/// Sorts, lane by lane, the largest first.
template <typename V>
HWY_INLINE void sort_keys(V (&keys)[tree_width]) {
    // The 19 comparisons that suffice for eight (Knuth, volume 3, 5.3.4).
    constexpr std::uint8_t first[] = {0, 1, 4, 5, 0, 1, 2, 3, 0, 2, 4, 6, 2, 3, 1, 3, 1, 3, 5};
    constexpr std::uint8_t second[] = {2, 3, 6, 7, 4, 5, 6, 7, 1, 3, 5, 7, 4, 5, 4, 6, 2, 4, 6};
    for (std::size_t i = 0; i < std::size(first); ++i)
        put_in_order(keys[first[i]], keys[second[i]]);
}

constexpr std::uint32_t number_bits = tree_width - 1;

/// A child's places in the orders, made into keys that differ from those of the others: their last
/// bits are the child's number. The larger the place, the longer the child is kept waiting.
HWY_INLINE hn::Vec<Octants> key_of(hn::Vec<Octants> place, std::size_t child, std::size_t count) {
    const Octants d;
    const Bits bits;
    constexpr float most = std::numeric_limits<float>::max() / 2;
    // No number becomes 0, and those that are absent come last.
    auto key = hn::IfThenElseZero(hn::Eq(place, place), place);
    key = hn::Min(hn::Max(key, hn::Set(d, -most)), hn::Set(d, most));
    // Not 0: where tiny numbers count as 0, keys would not differ.
    const auto least = hn::Set(d, 0x1p-100F);
    key = hn::IfThenElse(hn::Lt(hn::Abs(key), least), least, key);
    if (child >= count)
        key = hn::Set(d, -2 * most);
    return hn::BitCast(
        d,
        hn::Or(
            hn::AndNot(hn::Set(bits, number_bits), hn::BitCast(bits, key)),
            hn::Set(bits, static_cast<std::uint32_t>(child))));
}

void set_orders_kernel(WideNode& node, std::size_t count) {
    const Octants d;
    const Bits bits;
    using V = hn::Vec<Octants>;
    alignas(64) std::uint32_t numbers[octant_count];
    std::uint64_t upper[tree_width] = {};
    const auto sign = hn::Set(bits, 0x80000000U);
    for (std::size_t first = 0; first < octant_count; first += hn::Lanes(d)) {
        const auto octants = hn::Iota(bits, static_cast<std::uint32_t>(first));
        const V backward[3] = {
            hn::BitCast(d, hn::ShiftLeft<31>(octants)),
            hn::BitCast(d, hn::And(hn::ShiftLeft<30>(octants), sign)),
            hn::BitCast(d, hn::And(hn::ShiftLeft<29>(octants), sign))};
        V keys[tree_width];
        for (std::size_t i = 0; i < tree_width; ++i) {
            V place = hn::Zero(d);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const float middle = node.planes[axis][i] + node.planes[3 + axis][i];
                place = hn::Add(place, hn::Xor(hn::Set(d, middle), backward[axis]));
            }
            keys[i] = key_of(place, i, count);
        }
        sort_keys(keys);
        for (std::size_t i = 0; i < tree_width; ++i) {
            hn::Store(
                hn::And(hn::BitCast(bits, keys[i]), hn::Set(bits, number_bits)), bits, numbers);
            for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane)
                upper[i] |= std::uint64_t{numbers[lane]} << TreeChild::order_shift_of(first + lane);
        }
    }
    for (std::size_t i = 0; i < tree_width; ++i)
        node.children[i].bits |= upper[i];
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vera::detail {

HWY_EXPORT(set_orders_kernel);

void set_orders(WideNode& node, std::size_t count) {
    HWY_DYNAMIC_DISPATCH(set_orders_kernel)(node, count);
}

} // namespace vera::detail

#endif
