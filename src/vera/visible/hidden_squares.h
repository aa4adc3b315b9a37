// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/cells.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// What blocks squares of cells: a quad-tree over them, so that a long sliver behind something
/// large is known to be hidden without being followed from cell to cell (after the depth pyramid of
/// Greene, Kass and Miller, Hierarchical Z-buffer visibility, 1993). Of cells that are blocked
/// later nothing is known.
class HiddenSquares {
public:
    explicit HiddenSquares(const Cells& cells);

    /// Whether everything so near is hidden in all cells that the triangle touches, or that
    /// for_each_cell_of() visits beside it. Perhaps false where it is; always, where the triangle
    /// touches few cells, which are as soon asked.
    template <std::size_t Count>
    bool hide(double near, const std::array<ScreenPoint, Count>& corners) const {
        return hide(near, corners, [] {});
    }

    /// The same, which calls visit() for each square that is looked at.
    template <std::size_t Count, typename Visit>
    bool
    hide(double near, const std::array<ScreenPoint, Count>& corners, const Visit& visit) const {
        if (levels_.empty() || !is_long(corners.data(), Count))
            return false;
        return hides(near, Figure{corners.data(), Count}, {levels_.size() - 1, 0, 0}, visit);
    }

private:
    /// A square of the level has twice the width of one below; those of level 0 are `smallest`
    /// cells wide, since fewer would be no less work than their cells.
    static constexpr std::int32_t smallest = 8;

    struct Square {
        std::size_t level = 0;
        std::int32_t column = 0;
        std::int32_t row = 0;
    };

    struct Figure {
        const ScreenPoint* corners = nullptr;
        std::size_t count = 0;
    };

    std::size_t place_of(const Square& square) const {
        return (static_cast<std::size_t>(square.row) << (levels_.size() - 1 - square.level))
            + static_cast<std::size_t>(square.column);
    }

    bool is_long(const ScreenPoint* corners, std::size_t count) const;
    bool may_touch(const Square& square, const Figure& figure) const;

    template <typename Visit>
    bool hides(double near, const Figure& figure, const Square& square, const Visit& visit) const {
        visit();
        if (near < levels_[square.level][place_of(square)] || !may_touch(square, figure))
            return true;
        if (square.level == 0)
            return false;
        for (const std::int32_t row : {2 * square.row, 2 * square.row + 1})
            for (const std::int32_t column : {2 * square.column, 2 * square.column + 1})
                if (!hides(near, figure, {square.level - 1, column, row}, visit))
                    return false;
        return true;
    }

    int shift_ = screen_bits;                 ///< of the cells
    std::vector<std::vector<double>> levels_; ///< row by row, the smallest squares first
};

} // namespace vera
