// SPDX-License-Identifier: Apache-2.0
// What rectangles with sides along the axes cover together, by its border alone. Coordinates are
// numbered, so that neighbouring ones have a row or a column of cells between them, each covered or
// free. The border is kept as pieces in two window trees, one for each axis: so what of it lies in
// a further rectangle is found in O(log^2 n) and as much for each piece.
//
// A piece is told from its free side: it belongs to a rectangle if the free cells beside it do.
// That decides by itself what becomes of borders that coincide or touch.
#pragma once

#include "vera/theory/window_tree.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// The cells in the columns cells[0] and the rows cells[1], neither of which is empty.
struct CellBox {
    std::array<PlaceRange, 2> cells;
};

/// The corner of the cell of column x and row y at which both begin. Behind the last there is one
/// more each.
struct GridCorner {
    std::int32_t x = 0;
    std::int32_t y = 0;

    friend constexpr bool operator==(GridCorner, GridCorner) = default;
    friend constexpr auto operator<=>(GridCorner, GridCorner) = default;
};

/// Of the border of an area, which lies on its left; y grows upward.
struct GridEdge {
    GridCorner from;
    GridCorner to;
};

/// A side of a box, along the axis.
struct BoxSide {
    std::size_t axis = 0;
    std::int32_t inside = 0; ///< the number across of the box's cells beside it
    bool is_upper = false;
    std::vector<PlaceRange> free; ///< where the cells inside are free, in ascending order
};

/// What a box that is to be covered meets.
struct BoxMeeting {
    CellBox box;
    std::array<std::vector<WindowSegment>, 2> pieces; ///< of the border, along x and along y
    std::vector<BoxSide> sides;

    /// That cover() may return of it.
    std::size_t most_edges() const;
};

class CoveredUnion {
public:
    /// Nothing is covered at first. The counts must outlive this.
    CoveredUnion(std::int32_t columns, std::int32_t rows, WindowCounts& counts);

    /// Takes O((1 + p) log^2 n) for p pieces of the border that are in the box.
    BoxMeeting meeting(const CellBox& box) const;

    /// By how many entry_count() may grow, at most, while a box that meets this is covered.
    std::size_t most_new_entries(const BoxMeeting& meeting) const;

    /// Covers the box, of which the meeting was the last thing asked for. Returns the border of
    /// what of it was free before, in no particular order, and straight parts of it perhaps as
    /// several edges; nothing if all was covered. Takes as long.
    std::vector<GridEdge> cover(const BoxMeeting& meeting);

    /// In all nodes of the trees: see WindowTree::bytes_of_entry.
    std::size_t entry_count() const { return along_[0].entry_count() + along_[1].entry_count(); }

private:
    BoxSide side_of(const BoxMeeting& meeting, std::size_t axis, bool is_upper) const;
    void uncover(const CellBox& box, std::size_t axis, const WindowSegment& piece);
    void add_border(const BoxSide& side, const std::vector<WindowSegment>& met);

    /// Along x, and along y: at 2 i where the cells of number i across, which begin there, are
    /// free, and at 2 i + 1 where those of number i, which end there, are.
    std::array<WindowTree, 2> along_;
};

} // namespace vera
