// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// Borders of things, found by place. A line along a seam reaches a little to either side, and what
/// is painted later covers it there; but where the later outline is narrower than that, as facets
/// near a silhouette are, the line would come out behind it and paint over the background, or over
/// a thing that was painted before.
class ForeignBorders {
public:
    /// One side of the border, of what is painted the earlier of the two.
    struct Border {
        DrawingPoint begin;
        DrawingPoint end;
        std::uint32_t order = 0; ///< in which it is painted: 0 is the background
        std::uint32_t thing = 0; ///< of which it is a part
    };

    /// For a picture of that size and lines that reach that far to either side, in pixels.
    ForeignBorders(double width, double height, double reach, std::vector<Border> borders);

    /// The parts of the segment from begin to end, in its order, along which a line in the colour
    /// of that thing, painted in that order, reaches over no earlier painted border of another
    /// thing.
    std::vector<std::vector<DrawingPoint>> clear_parts(
        DrawingPoint begin, DrawingPoint end, std::uint32_t order, std::uint32_t thing) const;

private:
    /// Calls visit(cell) for the cells that a segment, and what is no farther from it than reach,
    /// may lie in.
    template <typename Visit>
    void for_each_cell(DrawingPoint begin, DrawingPoint end, const Visit& visit) const;

    std::vector<Border> borders_;
    double reach_;
    std::size_t columns_ = 1;
    std::size_t rows_ = 1;
    double columns_per_pixel_ = 0;
    double rows_per_pixel_ = 0;
    std::vector<std::size_t> first_of_cell_;
    std::vector<std::uint32_t> in_cells_; ///< numbers of borders, cell by cell
};

} // namespace vera
