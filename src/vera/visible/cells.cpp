// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/cells.h"

#include <array>
#include <cmath>
#include <limits>

namespace vera {

namespace {

struct CellRange {
    std::int32_t first_column;
    std::int32_t last_column;
    std::int32_t first_row;
    std::int32_t last_row;
};

CellRange range_of(const Cells& cells, const std::array<ScreenVertex, 3>& corners) {
    ScreenPoint low = corners[0].point;
    ScreenPoint high = low;
    for (const ScreenVertex& corner : corners) {
        low = {std::min(low.x, corner.point.x), std::min(low.y, corner.point.y)};
        high = {std::max(high.x, corner.point.x), std::max(high.y, corner.point.y)};
    }
    return {
        cells.cell_of(low.x), cells.cell_of(high.x), cells.cell_of(low.y), cells.cell_of(high.y)};
}

/// How a triangle and a cell, its border included, lie to each other.
struct Overlap {
    bool touches = true;
    bool covers = true;
};

Overlap
overlap(const Cells& cells, const std::array<ScreenVertex, 3>& corners, ScreenPoint lower) {
    const std::int64_t size = std::int64_t{1} << cells.shift;
    Overlap result;
    for (std::size_t i = 0; i < 3; ++i) {
        const ScreenPoint from = corners[i].point;
        const ScreenStep side = step(from, corners[(i + 1) % 3].point);
        // Positive inside; at the cell's corner where that is largest, and where it is smallest.
        const std::int64_t at_lower = cross(side, step(from, lower));
        const std::int64_t largest =
            at_lower + size * (std::max<std::int64_t>(-side.y, 0) + std::max<std::int64_t>(side.x, 0));
        const std::int64_t smallest =
            at_lower + size * (std::min<std::int64_t>(-side.y, 0) + std::min<std::int64_t>(side.x, 0));
        result.touches = result.touches && largest >= 0;
        result.covers = result.covers && smallest >= 0;
    }
    return result;
}

/// Not more than how near the plane is at any point of the cell.
std::int64_t least_nearness(const Cells& cells, const DepthPlane& plane, ScreenPoint lower) {
    const double size = std::ldexp(1.0, cells.shift);
    double least = std::numeric_limits<double>::infinity();
    for (const double x : {0.0, size})
        for (const double y : {0.0, size})
            least = std::min(least, plane.value(lower.x + x, lower.y + y));
    // Within a triangle the terms of value() are at most 2^34, for slivers far more; but those cover
    // no cell.
    return static_cast<std::int64_t>(std::floor(least)) - 1;
}

/// Calls visit(number, lower corner) for the cells in the range that the triangle touches.
template <typename Visit>
void for_each_cell_of(
    const Cells& cells, const std::array<ScreenVertex, 3>& corners, const Visit& visit) {
    const CellRange range = range_of(cells, corners);
    const bool is_small = range.last_column - range.first_column <= 1
        && range.last_row - range.first_row <= 1;
    for (std::int32_t row = range.first_row; row <= range.last_row; ++row)
        for (std::int32_t column = range.first_column; column <= range.last_column; ++column) {
            const ScreenPoint lower = {column << cells.shift, row << cells.shift};
            const Overlap found = is_small ? Overlap{true, false} : overlap(cells, corners, lower);
            if (found.touches)
                visit(cells.number(column, row), lower, found.covers);
        }
}

std::int64_t nearest(const std::array<ScreenVertex, 3>& corners) {
    return std::max({corners[0].nearness, corners[1].nearness, corners[2].nearness});
}

int shift_for(std::size_t triangles) {
    // Two to four cells a side for the root of their number: the optimum is flat.
    int bits = 1;
    while (bits < screen_bits - 4
           && std::ldexp(1.0, 2 * bits) < 4 * static_cast<double>(triangles))
        ++bits;
    return screen_bits - bits;
}

} // namespace

Cells cells_of(const ScreenScene& scene, std::span<const DepthPlane> planes) {
    Cells cells;
    cells.shift = shift_for(scene.triangles.size());
    cells.per_side = std::int32_t{1} << (screen_bits - cells.shift);
    const std::size_t count =
        static_cast<std::size_t>(cells.per_side) * static_cast<std::size_t>(cells.per_side);
    cells.blocked.assign(count, -1);
    for (std::size_t i = 0; i < scene.triangles.size(); ++i)
        for_each_cell_of(
            cells,
            corners_of(scene, scene.triangles[i]),
            [&](std::size_t cell, ScreenPoint lower, bool covers) {
                if (covers)
                    cells.blocked[cell] = std::max(
                        cells.blocked[cell], least_nearness(cells, planes[i], lower));
            });

    const auto for_each_entry = [&](const auto& visit) {
        for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
            const auto corners = corners_of(scene, scene.triangles[i]);
            const std::int64_t near = nearest(corners);
            for_each_cell_of(cells, corners, [&](std::size_t cell, ScreenPoint, bool) {
                if (near >= cells.blocked[cell])
                    visit(cell, i);
            });
        }
    };
    cells.starts.assign(count + 1, 0);
    for_each_entry([&](std::size_t cell, std::uint32_t) { ++cells.starts[cell + 1]; });
    for (std::size_t i = 1; i < cells.starts.size(); ++i)
        cells.starts[i] += cells.starts[i - 1];
    cells.triangles.resize(cells.starts.back());
    std::vector<std::uint32_t> next(cells.starts.begin(), cells.starts.end() - 1);
    for_each_entry(
        [&](std::size_t cell, std::uint32_t i) { cells.triangles[next[cell]++] = i; });
    return cells;
}

} // namespace vera
