// SPDX-License-Identifier: Apache-2.0
// Inverse range queries (VERA 3.3.1): of rectangles of a plane of places, the first one that holds
// a given place. Two segment trees, one in the other: the nodes of the outer one that hold a place
// across have, together, the rectangles that reach over it; each has what it needs to look among
// its own along. For lines the first of all is asked for, and a node keeps, between two borders
// each, which that is: O(log^2 n). For rays it is the first from some rank on, or the last up to
// it, and a node is a segment tree again, of sorted lists: O(log^3 n).
#pragma once

#include "vera/theory/pivot_ranges.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace vera {

/// The order in which rectangles are met, from 0: by z and number.
using RectangleRank = std::uint16_t;

enum class Stabbing {
    first_of_all, ///< for lines
    from_a_rank   ///< for rays
};

class StabbingTree {
public:
    /// Of rectangles, each of its rank in the list, across from some place to some other, and along
    /// likewise. Where a range is empty the rectangle holds no place.
    StabbingTree(
        Stabbing kind,
        std::span<const PivotRange> across,
        std::size_t places_across,
        std::span<const PivotRange> along);

    /// The smallest rank of those that hold the place.
    std::optional<RectangleRank>
    first(PivotPlace across, PivotPlace along, DualCounts& counts) const;

    /// The smallest rank that is no smaller than `least`. Only of trees for rays.
    std::optional<RectangleRank>
    first_from(PivotPlace across, PivotPlace along, std::uint32_t least, DualCounts& counts) const;

    /// The largest rank that is smaller than `end`. Only of trees for rays.
    std::optional<RectangleRank>
    last_before(PivotPlace across, PivotPlace along, std::uint32_t end, DualCounts& counts) const;

    std::size_t bytes() const;

    /// At most so much, in bytes, for so many rectangles.
    static double bytes_forecast(Stabbing kind, std::size_t rectangles);

private:
    /// A rectangle that a node holds.
    struct Entry {
        PivotRange along;
        RectangleRank rank = 0;
    };

    /// What a node of more than a few has. The borders part the places along; of each part it keeps
    /// the first rank, or it is a leaf of a segment tree of sorted ranks.
    struct Inner {
        std::vector<PivotPlace> borders;   ///< at which parts but the first begin
        std::vector<RectangleRank> ranks;  ///< of each part; or of each node in turn
        std::vector<std::uint32_t> starts; ///< of nodes in ranks, and the end

        std::size_t part_of(PivotPlace along, DualCounts& counts) const;
    };

    Inner inner_of(std::span<const Entry> entries) const;
    static Inner first_ranks(std::span<const Entry> entries, Inner inner);
    static Inner sorted_ranks(std::span<const Entry> entries, Inner inner);
    std::span<const Entry> entries_of(std::size_t node) const;

    template <typename OfEntry, typename OfInner>
    void visit(
        PivotPlace across,
        PivotPlace along,
        DualCounts& counts,
        const OfEntry& of_entry,
        const OfInner& of_inner) const;

    static constexpr RectangleRank none = 0xffff;
    static constexpr std::size_t few = 8; ///< entries are looked at one by one

    Stabbing kind_;
    std::size_t leaves_ = 1;            ///< of the outer tree, a power of 2
    std::vector<std::uint32_t> starts_; ///< of the nodes' entries, root is number 1; and the end
    std::vector<Entry> entries_;
    std::vector<std::uint32_t> inner_of_; ///< of each node, its number in inner_ and 1, or 0
    std::vector<Inner> inner_;
};

/// The nodes of a segment tree with so many leaves, a power of 2, that together hold the leaves
/// from first to last, none twice; their parents do not all belong. The root is 1, and the children
/// of i are 2i and 2i + 1.
template <typename Visit>
void for_each_canonical_node(
    std::size_t leaves, std::size_t first, std::size_t last, const Visit& visit) {
    for (std::size_t low = first + leaves, high = last + leaves + 1; low < high;
         low /= 2, high /= 2) {
        if (low % 2 == 1)
            visit(low++);
        if (high % 2 == 1)
            visit(--high);
    }
}

} // namespace vera
