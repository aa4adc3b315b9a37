// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/exact/depth_plane.h"
#include "vera/visible/front_order.h"
#include "vera/visible/screen_scene.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace vera {

/// The picture cut into square cells, each with the triangles that touch it (Franklin 1980). Where
/// many crowd, a cell is cut again. What lies behind a triangle that covers a cell is left out there.
struct Cells {
    /// A square of 2^bits x 2^bits cells, each 2^shift steps wide and high.
    struct Grid {
        ScreenPoint low;
        int shift = screen_bits;
        int bits = 0;
        std::uint32_t first_cell = 0; ///< its cells have the numbers from there on, row by row

        std::int32_t per_side() const { return std::int32_t{1} << bits; }

        std::uint32_t cell(std::int32_t column, std::int32_t row) const {
            return first_cell
                + (static_cast<std::uint32_t>(row) << static_cast<unsigned>(bits))
                + static_cast<std::uint32_t>(column);
        }

        /// Which of the columns from `low` on, or of the rows, the coordinate is in: the first or
        /// last where it is outside.
        std::int32_t place(std::int64_t coordinate, std::int32_t from) const {
            return static_cast<std::int32_t>(
                std::clamp<std::int64_t>((coordinate - from) >> shift, 0, per_side() - 1));
        }
    };

    static constexpr std::uint32_t no_grid = ~std::uint32_t{0};

    std::vector<Grid> grids;             ///< the first is the whole picture's
    std::vector<std::uint32_t> within;   ///< of cells: the grid that cuts it again, or no_grid
    std::vector<std::uint32_t> starts;   ///< cell i has the triangles [starts[i]] to [starts[i + 1]]
    std::vector<std::uint32_t> triangles; ///< in ascending order within a cell
    /// What is less near, by its own hidden_margin(), is hidden everywhere in the cell.
    std::vector<double> blocked;

    std::span<const std::uint32_t> triangles_of(std::size_t cell) const {
        return std::span(triangles).subspan(starts[cell], starts[cell + 1] - starts[cell]);
    }
};

/// Columns of cells, none where last < first.
struct Columns {
    std::int32_t first = 0;
    std::int32_t last = -1;
};

/// What of a row of cells a triangle touches, and what it covers altogether.
struct RowOfCells {
    Columns touched;
    Columns covered;
};

/// Goes through the rows of a grid that a triangle touches.
class RowsOfCells {
public:
    RowsOfCells(const Cells::Grid& grid, const std::array<ScreenVertex, 3>& corners);

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

    const Cells::Grid& grid_;
    const std::array<ScreenVertex, 3>& corners_;
    double per_cell_;
    std::int32_t first_ = 0;
    std::int32_t last_ = 0;
    std::int64_t y_ = 0; ///< where the next row begins
    Chord at_y_;
};

/// Calls visit(row, RowOfCells) for the rows of the grid that the triangle touches.
template <typename Visit>
void for_each_row_of(
    const Cells::Grid& grid, const std::array<ScreenVertex, 3>& corners, const Visit& visit) {
    RowsOfCells rows(grid, corners);
    for (std::int32_t row = rows.first(); row <= rows.last(); ++row)
        visit(row, rows.next());
}

/// Calls visit(number of the cell) for the cells that the triangle touches, and perhaps some beside
/// it. None of them is cut again.
template <typename Visit>
void for_each_cell_of(
    const Cells& cells,
    const std::array<ScreenVertex, 3>& corners,
    const Visit& visit,
    std::uint32_t grid_number = 0) {
    const Cells::Grid& grid = cells.grids[grid_number];
    for_each_row_of(grid, corners, [&](std::int32_t row, const RowOfCells& found) {
        for (std::int32_t column = found.touched.first; column <= found.touched.last; ++column) {
            const std::uint32_t cell = grid.cell(column, row);
            if (cells.within[cell] != Cells::no_grid)
                for_each_cell_of(cells, corners, visit, cells.within[cell]);
            else
                visit(cell);
        }
    });
}

/// planes[i] and slopes[i] are those of triangle i. Where many triangles lie one behind the other
/// there are fewer cells, so that the lists stay in proportion to the triangles.
Cells cells_of(
    const ScreenScene& scene,
    std::span<const DepthPlane> planes,
    std::span<const NearnessSlope> slopes,
    const CancelFlag* cancel = nullptr);

/// The same where planes and slopes are not needed otherwise.
Cells cells_of(const ScreenScene& scene, const CancelFlag* cancel = nullptr);

/// By how much something must be behind what blocks a cell to be hidden there whatever the order of
/// the two: see front_order.h.
inline double hidden_margin(const NearnessSlope& slope) {
    return 2 * slope.per_step() + 2;
}

/// Calls visit(number of the cell) for the cells that the segment from a to b touches, until that
/// returns false; true where it never did. None of them is cut again.
template <typename Visit>
bool for_each_cell_along(
    const Cells& cells,
    ScreenPoint a,
    ScreenPoint b,
    const Visit& visit,
    std::uint32_t grid_number = 0) {
    const Cells::Grid& grid = cells.grids[grid_number];
    const ScreenStep whole = step(a, b);
    const bool by_columns =
        (whole.x < 0 ? -whole.x : whole.x) >= (whole.y < 0 ? -whole.y : whole.y);
    // In axes along which the segment is longer, and across.
    const auto along = [&](ScreenPoint p) { return by_columns ? p.x : p.y; };
    const auto across = [&](ScreenPoint p) { return by_columns ? p.y : p.x; };
    const ScreenPoint low = along(a) <= along(b) ? a : b;
    const ScreenPoint high = along(a) <= along(b) ? b : a;
    const std::int64_t length = along(high) - along(low);
    const std::int64_t rise = across(high) - across(low);
    const auto visit_run = [&](std::int32_t slice, std::int64_t from, std::int64_t to) {
        // A segment on the border of two rows of cells touches both.
        const std::int64_t lowest = std::min(from, to) - 1;
        const std::int64_t highest = std::max(from, to) + 1;
        const std::int64_t begin = across(grid.low);
        if (highest < begin || lowest > begin + (std::int64_t{1} << (grid.shift + grid.bits)))
            return true;
        const std::int32_t last = grid.place(highest, across(grid.low));
        for (std::int32_t i = grid.place(lowest, across(grid.low)); i <= last; ++i) {
            const std::uint32_t cell = by_columns ? grid.cell(slice, i) : grid.cell(i, slice);
            const bool goes_on = cells.within[cell] != Cells::no_grid
                ? for_each_cell_along(cells, a, b, visit, cells.within[cell])
                : visit(cell);
            if (!goes_on)
                return false;
        }
        return true;
    };
    const std::int32_t last = grid.place(along(high), along(grid.low));
    for (std::int32_t slice = grid.place(along(low), along(grid.low)); slice <= last; ++slice) {
        const std::int64_t begin = along(grid.low) + (std::int64_t{slice} << grid.shift);
        const std::int64_t end = begin + (std::int64_t{1} << grid.shift);
        // A grid within another may begin behind the segment, or end before it.
        const std::int64_t enters = std::min<std::int64_t>(std::max<std::int64_t>(along(low), begin), along(high));
        const std::int64_t leaves = std::max<std::int64_t>(std::min<std::int64_t>(along(high), end), along(low));
        const auto height = [&](std::int64_t at) {
            return length == 0 ? across(low) : across(low) + rise * (at - along(low)) / length;
        };
        if (!visit_run(slice, height(enters), height(leaves)))
            return false;
    }
    return true;
}

} // namespace vera
