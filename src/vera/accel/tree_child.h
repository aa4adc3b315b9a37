// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace vera::detail {

/// Children of a node of a tree of boxes, and elements of a leaf's block.
constexpr std::size_t tree_width = 8;
constexpr std::size_t block_width = 4;

/// Directions of rays, by the axes along which they run backward: bit a for axis a.
constexpr std::size_t octant_count = 8;

/// The order in which rays that only ask whether they meet anything come to a node's children: that
/// of their numbers. The numbers below are those of the octants, in which others do.
constexpr std::size_t any_order = octant_count;

/// A child of a node of a tree of boxes, see WideNode, in 64 bits. The lower part says what it is:
/// another node, or a block of up to block_width elements of one kind; and where. The upper part
/// belongs to its place in the node rather than to the child: which of the node's children is the
/// one to be kept longest waiting there, for each octant. While a child waits for one ray, or for a
/// beam, its upper part says where that enters its box.
struct TreeChild {
    std::uint64_t bits = 0;

    static constexpr unsigned block_shift = 31;
    static constexpr unsigned kind_shift = 32;
    static constexpr unsigned count_shift = 35;
    static constexpr unsigned order_shift = 37;
    static constexpr unsigned order_width = 3;
    static constexpr std::uint64_t lower_part = (std::uint64_t{1} << order_shift) - 1;

    /// Nodes, or rows of blocks, of a tree are at most so many.
    static constexpr std::uint64_t most = std::uint64_t{1} << block_shift;

    static constexpr TreeChild node(std::uint64_t number) { return {number}; }

    /// A block of elements of the kind, with its first row.
    static constexpr TreeChild
    block(std::uint64_t first_row, std::uint64_t kind, std::size_t count) {
        return {
            first_row | std::uint64_t{1} << block_shift | kind << kind_shift
            | std::uint64_t{count - 1} << count_shift};
    }

    /// The number of the node, or of the block's first row.
    constexpr std::size_t first() const { return bits & (most - 1); }

    /// first() of what is known to be a node.
    constexpr std::size_t node_number() const { return static_cast<std::uint32_t>(bits); }

    /// 1 for a block, 0 for a node.
    constexpr std::size_t is_block() const { return bits >> block_shift & 1U; }

    constexpr std::uint32_t kind() const {
        return static_cast<std::uint32_t>(bits >> kind_shift & 7U);
    }

    constexpr std::size_t count() const { return (bits >> count_shift & 3U) + 1; }

    /// Says at this place of a node that in this order, which is not any_order, the child of that
    /// number waits here.
    constexpr void set_order(std::size_t order, std::uint64_t number) {
        bits |= number << order_shift_of(order);
    }

    static constexpr unsigned order_shift_of(std::size_t order) {
        return order_shift + order_width * static_cast<unsigned>(order);
    }

    constexpr std::size_t in_order(std::size_t order) const {
        return bits >> order_shift_of(order) & 7U;
    }

    /// The child as it waits, entered at near >= 0, of which the last digits are dropped.
    static TreeChild waiting(TreeChild child, float near) {
        const std::uint64_t upper = std::uint64_t{std::bit_cast<std::uint32_t>(near)} << 32U;
        return {(child.bits & lower_part) | (upper & ~lower_part)};
    }

    /// Where a waiting child is entered.
    float near() const {
        return std::bit_cast<float>(static_cast<std::uint32_t>((bits & ~lower_part) >> 32U));
    }
};

} // namespace vera::detail
