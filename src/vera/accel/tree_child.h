// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace vera::detail {

/// Children of a node of a tree of boxes.
constexpr std::size_t tree_width = 8;

/// Directions of rays, by the axes along which they run backward: bit a for axis a.
constexpr std::size_t octant_count = 8;

/// A child of a node of a tree of boxes, see WideNode, in 64 bits: the number of the node or of the
/// block's first row, its ChildKind, the number of the block's elements, and, which belongs to the
/// place of the child rather than to the child, which of the node's children rays of each octant
/// should come to at this place.
struct TreeChild {
    std::uint64_t bits = 0;

    static constexpr unsigned kind_shift = 32;
    static constexpr unsigned block_shift = 35; ///< a bit of the kind
    static constexpr unsigned count_shift = 36;
    static constexpr unsigned order_shift = 40;
    static constexpr unsigned order_width = 3;

    static constexpr TreeChild of(std::uint64_t first, std::uint8_t kind, std::size_t count) {
        return {first | std::uint64_t{kind} << kind_shift | std::uint64_t{count} << count_shift};
    }

    constexpr std::uint32_t first() const { return static_cast<std::uint32_t>(bits); }

    constexpr std::uint8_t kind() const {
        return static_cast<std::uint8_t>(bits >> kind_shift & 15U);
    }

    /// 1 for a block, 0 for a node.
    constexpr std::size_t is_block() const { return bits >> block_shift & 1U; }

    constexpr std::size_t count() const { return bits >> count_shift & 15U; }

    constexpr std::size_t in_turn(std::size_t octant) const {
        return bits >> (order_shift + order_width * octant) & 7U;
    }
};

} // namespace vera::detail
