// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/visible/triangle_order.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace vera {

struct SheetScene;

/// The picture cut into square cells, each with the surfaces that touch it (Franklin 1980). What
/// lies behind a triangle that covers a cell is left out there. Shadows are not in them.
struct Cells {
    int shift = screen_bits; ///< a cell is 2^shift steps wide and high
    std::int32_t per_side = 1;
    std::vector<std::uint32_t> starts; ///< cell i has the triangles [starts[i]] to [starts[i + 1]]
    std::vector<std::uint32_t> triangles; ///< in ascending order within a cell
    /// What is less near, by its own hidden_margin(), is hidden everywhere in the cell.
    std::vector<double> blocked;
    std::vector<std::uint8_t> hides_nothing; ///< of cells; empty: none is asked for so

    std::int32_t cell_of(std::int32_t coordinate) const {
        return std::min(coordinate >> shift, per_side - 1);
    }

    std::size_t number(std::int32_t column, std::int32_t row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(per_side)
            + static_cast<std::size_t>(column);
    }

    bool hides_nothing_in(std::size_t cell) const {
        return !hides_nothing.empty() && hides_nothing[cell] != 0;
    }

    std::span<const std::uint32_t> triangles_of(std::size_t cell) const {
        return std::span(triangles).subspan(starts[cell], starts[cell + 1] - starts[cell]);
    }
};

/// Columns of cells, none where last < first.
struct Columns {
    std::int32_t first = 0;
    std::int32_t last = -1;
};

/// Tells whether any of several cells of a row are marked, with no look at each.
class CellsInRows {
public:
    CellsInRows(const Cells& cells, const std::vector<std::uint8_t>& is_marked);

    bool are_any(Columns columns, std::int32_t row) const {
        const std::size_t begin = static_cast<std::size_t>(row) * row_size_;
        return before_[begin + static_cast<std::size_t>(columns.first)]
            != before_[begin + static_cast<std::size_t>(columns.last) + 1];
    }

private:
    std::size_t row_size_;
    std::vector<std::uint32_t> before_; ///< how many of the row are, before each, and in all
};

/// What of a row of cells a triangle touches, and what it covers altogether.
struct RowOfCells {
    Columns touched;
    Columns covered;
};

/// Goes through the rows of cells that a triangle touches.
class RowsOfCells {
public:
    /// The rows from first to last, of those that the triangle touches.
    RowsOfCells(
        const Cells& cells,
        const std::array<ScreenVertex, 3>& corners,
        std::int32_t first,
        std::int32_t last);

    RowsOfCells(const Cells& cells, const std::array<ScreenVertex, 3>& corners)
        : RowsOfCells(cells, corners, 0, cells.per_side - 1) {}

    std::int32_t first() const { return first_; }

    std::int32_t last() const { return last_; }

    /// What of the row the triangle touches and covers; perhaps a cell more of the one, and a cell
    /// less of the other. To be asked from the first to the last.
    RowOfCells next();

private:
    /// The part of a line across the picture that lies in the triangle; none where right < left.
    struct Chord {
        double left = std::numeric_limits<double>::infinity();
        double right = -std::numeric_limits<double>::infinity();

        void include(double x) {
            left = std::min(left, x);
            right = std::max(right, x);
        }
    };

    Chord chord_at(std::int64_t y) const;

    const Cells& cells_;
    const std::array<ScreenVertex, 3>& corners_;
    double per_cell_;
    std::int32_t first_ = 0;
    std::int32_t last_ = 0;
    std::array<double, 3> slopes_ = {}; ///< of the sides, from height to height; finite where asked
    std::int64_t y_ = 0;                ///< where the next row begins
    Chord at_y_;
};

/// Calls visit(row, RowOfCells) for the rows that the triangle touches.
template <typename Visit>
void for_each_row_of(
    const Cells& cells, const std::array<ScreenVertex, 3>& corners, const Visit& visit) {
    RowsOfCells rows(cells, corners);
    for (std::int32_t row = rows.first(); row <= rows.last(); ++row)
        visit(row, rows.next());
}

/// Calls visit(number of the cell) for the cells that the triangle touches, and perhaps some beside
/// it.
template <typename Visit>
void for_each_cell_of(
    const Cells& cells, const std::array<ScreenVertex, 3>& corners, const Visit& visit) {
    for_each_row_of(cells, corners, [&](std::int32_t row, const RowOfCells& found) {
        for (std::int32_t column = found.touched.first; column <= found.touched.last; ++column)
            visit(cells.number(column, row));
    });
}

/// Of a cell, whether its list is asked for, and with what is hidden there.
enum AskedCell : std::uint8_t { not_asked, asked_for, asked_with_hidden };

/// Tells of cells, which have no lists yet, which ones are asked for, as AskedCell. Called once:
/// where there are fewer cells in the end, those are asked for of which a part is.
using AskedCells = std::function<std::vector<std::uint8_t>(const Cells&)>;

/// slopes[i] is that of triangle i. Where many triangles lie one behind the other
/// there are fewer cells, so that the lists stay in proportion to the triangles.
/// Cells that are not asked for have empty lists and block everything. Where the scene's sheets are
/// given, those of triangles far larger than cells hide as well (block_by_sheets()).
Cells cells_of(
    const ScreenScene& scene,
    std::span<const NearnessSlope> slopes,
    const CancelFlag* cancel = nullptr,
    const AskedCells& asked = {},
    const SheetScene* sheets = nullptr);

/// The same where slopes are not needed otherwise.
Cells cells_of(const ScreenScene& scene, const CancelFlag* cancel = nullptr);

/// By how much something must be behind what blocks a cell to be hidden there whatever the order of
/// the two: a bit more than by that in which it would be compared.
inline double hidden_margin(const NearnessSlope& slope) {
    return sure_margin(slope) + 0x1p-26 * slope.per_step();
}

/// How near the plane is at the nearest of the points, as it may be compared with what blocks a
/// cell. Asked of the plane: a corner that was moved to the grid may be off it.
template <std::size_t Count>
double
nearest_for_hiding(const NearnessSlope& slope, const std::array<ScreenPoint, Count>& points) {
    double nearest = -std::numeric_limits<double>::infinity();
    for (const ScreenPoint point : points)
        nearest = std::max(
            nearest, slope.at({static_cast<double>(point.x), static_cast<double>(point.y)}));
    return nearest + hidden_margin(slope);
}

/// The cells that a part of a segment touches, and perhaps some beside it: of one column where the
/// segment is wider than high, else of one row.
struct CellSlice {
    std::int32_t number = 0; ///< of the slice along the segment, the lowest first
    std::int64_t enters = 0; ///< coordinates along which the segment is longer, of the part's ends
    std::int64_t leaves = 0;
    std::size_t first = 0; ///< cell; others follow at equal distances
    std::size_t distance = 1;
    std::int32_t count = 0;
};

/// A segment in the axes along which it is longer, and across; from its lower end along these.
class SegmentSlices {
public:
    SegmentSlices(const Cells& cells, ScreenPoint a, ScreenPoint b)
        : cells_(cells) {
        const ScreenStep whole = step(a, b);
        by_columns_ = (whole.x < 0 ? -whole.x : whole.x) >= (whole.y < 0 ? -whole.y : whole.y);
        const bool is_upward = along(a) <= along(b);
        low_ = is_upward ? a : b;
        high_ = is_upward ? b : a;
        first_ = cells.cell_of(along(low_));
        last_ = cells.cell_of(along(high_));
    }

    /// The coordinate along the segment.
    std::int32_t along(ScreenPoint p) const { return by_columns_ ? p.x : p.y; }

    std::int32_t count() const { return last_ - first_ + 1; }

    /// Calls visit(CellSlice) for the slices in their order, until that returns false; true where
    /// it never did.
    template <typename Visit>
    bool for_each(const Visit& visit) const {
        const std::int64_t length = along(high_) - along(low_);
        const std::int64_t rise = across(high_) - across(low_);
        const auto height = [&](std::int64_t at) {
            return length == 0 ? across(low_) : across(low_) + rise * (at - along(low_)) / length;
        };
        std::int64_t enters = along(low_);
        std::int64_t from = height(enters);
        for (std::int32_t i = first_; i <= last_; ++i) {
            const std::int64_t leaves =
                i == last_ ? along(high_) : std::int64_t{i + 1} << cells_.shift;
            const std::int64_t to = height(leaves);
            // A segment on the border of two rows of cells touches both.
            const std::int64_t lowest = std::max<std::int64_t>(std::min(from, to) - 1, 0);
            const std::int64_t highest =
                std::min<std::int64_t>(std::max(from, to) + 1, screen_size);
            const std::int32_t low = cells_.cell_of(static_cast<std::int32_t>(lowest));
            const std::int32_t high = cells_.cell_of(static_cast<std::int32_t>(highest));
            const auto per_side = static_cast<std::size_t>(cells_.per_side);
            if (!visit(CellSlice{
                    i - first_,
                    enters,
                    leaves,
                    by_columns_ ? cells_.number(i, low) : cells_.number(low, i),
                    by_columns_ ? per_side : 1,
                    high - low + 1}))
                return false;
            enters = leaves;
            from = to;
        }
        return true;
    }

private:
    std::int32_t across(ScreenPoint p) const { return by_columns_ ? p.y : p.x; }

    const Cells& cells_;
    bool by_columns_ = false;
    ScreenPoint low_;
    ScreenPoint high_;
    std::int32_t first_ = 0;
    std::int32_t last_ = 0;
};

/// Calls visit(number of the cell) for the cells of the slice, until that returns false; true where
/// it never did.
template <typename Visit>
bool for_each_cell_of(const CellSlice& slice, const Visit& visit) {
    std::size_t cell = slice.first;
    for (std::int32_t i = 0; i < slice.count; ++i, cell += slice.distance)
        if (!visit(cell))
            return false;
    return true;
}

/// Calls visit(number of the cell) for the cells that the segment from a to b touches, until that
/// returns false; true where it never did.
template <typename Visit>
bool for_each_cell_along(const Cells& cells, ScreenPoint a, ScreenPoint b, const Visit& visit) {
    return SegmentSlices(cells, a, b).for_each([&](const CellSlice& slice) {
        return for_each_cell_of(slice, visit);
    });
}

} // namespace vera
