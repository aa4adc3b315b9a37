// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/sheets.h"

#include "vera/base/long_loop.h"
#include "vera/base/parallel.h"
#include "vera/visible/screen_box.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <vector>

namespace vera {

namespace {

/// A closed square of the grid.
struct Square {
    ScreenPoint low;
    ScreenPoint high;
};

/// Whether the segment lies on the border of the picture, beyond which there is nothing.
bool is_on_border(ScreenPoint a, ScreenPoint b) {
    const auto is_on_line = [](std::int32_t first, std::int32_t second) {
        return first == second && (first == 0 || first == screen_size);
    };
    return is_on_line(a.x, b.x) || is_on_line(a.y, b.y);
}

bool do_meet(const Square& square, ScreenPoint a, ScreenPoint b) {
    return do_meet(
        ScreenBox{{square.low.x, square.high.x}, {square.low.y, square.high.y}}, std::array{a, b});
}

double nearest_of(const SheetScene& sheets, std::uint32_t triangle) {
    const auto corners = corners_of(sheets.scene, sheets.scene.triangles[triangle]);
    return nearest_for_hiding(
        sheets.slopes[triangle], std::array{corners[0].point, corners[1].point, corners[2].point});
}

/// Joins the triangles of one cell to sheets; kept from cell to cell.
class SheetsOfCell {
public:
    explicit SheetsOfCell(const SheetScene& sheets)
        : sheets_(sheets) {}

    /// Of the triangles those that hang together with another, in their order, as long as nothing
    /// else is asked: sheets are made of these alone.
    std::span<const std::uint32_t>
    joined(std::span<const std::uint32_t> triangles, const std::vector<std::uint8_t>& is_joined);

    /// How near the nearest sheet is that covers the cell, less what may be amiss; -1: there is
    /// none.
    double blocked(std::span<const std::uint32_t> triangles, const Square& square);

    /// Of the triangles the nearest, in ascending order, as long as nothing else is asked.
    std::span<const std::uint32_t>
    nearest(std::span<const std::uint32_t> triangles, std::size_t count);

private:
    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }

    void join(std::uint32_t i, std::span<const std::uint32_t> triangles, const Square& square);
    double least_nearness(std::uint32_t triangle, const Square& square) const;

    const SheetScene& sheets_;
    // Of the cell's triangles, by their place in its list.
    std::vector<std::uint32_t> parent_;
    std::vector<std::uint8_t> ends_here_; ///< whether the sheet has a border in the cell
    std::vector<double> least_;           ///< of the sheet at its root
    std::vector<std::pair<double, std::uint32_t>> by_nearness_;
    std::vector<std::uint32_t> nearest_;
    std::vector<std::uint32_t> joined_;
};

std::span<const std::uint32_t> SheetsOfCell::joined(
    std::span<const std::uint32_t> triangles, const std::vector<std::uint8_t>& is_joined) {
    joined_.clear();
    for (const std::uint32_t i : triangles)
        if (is_joined[i] != 0)
            joined_.push_back(i);
    return joined_;
}

/// Joins the triangle to those beyond its sides in the cell.
void SheetsOfCell::join(
    std::uint32_t i, std::span<const std::uint32_t> triangles, const Square& square) {
    const ScreenScene& scene = sheets_.scene;
    const ScreenTriangle& triangle = scene.triangles[triangles[i]];
    const ScreenPoint middle = {
        (square.low.x + square.high.x) / 2, (square.low.y + square.high.y) / 2};
    bool meets = false;
    bool contains = true;
    for (std::size_t side = 0; side < 3; ++side) {
        const ScreenPoint from = scene.vertices[triangle.vertices[side]].point;
        const ScreenPoint to = scene.vertices[triangle.vertices[(side + 1) % 3]].point;
        contains = contains && orientation(from, to, middle) > 0;
        if (!do_meet(square, from, to) || is_on_border(from, to))
            continue;
        meets = true;
        const EdgeNeighbours& beside =
            sheets_.neighbours[sheets_.edges.of_triangle[triangles[i]][side]];
        const std::uint32_t other = beside.left == triangles[i] ? beside.right : beside.left;
        // One that is hidden here already is not in the list.
        const auto found = beside.are_two()
            ? std::lower_bound(triangles.begin(), triangles.end(), other)
            : triangles.end();
        if (found == triangles.end() || *found != other)
            ends_here_[i] = 1;
        else
            parent_[root(i)] = root(static_cast<std::uint32_t>(found - triangles.begin()));
    }
    // It may be listed in the cell and yet lie beside it.
    if (!meets && !contains)
        ends_here_[i] = 1;
}

/// Not more than how near the triangle is at any of its points in the cell.
double SheetsOfCell::least_nearness(std::uint32_t triangle, const Square& square) const {
    const auto corners = corners_of(sheets_.scene, sheets_.scene.triangles[triangle]);
    const NearnessSlope& slope = sheets_.slopes[triangle];
    double of_corners = std::numeric_limits<double>::infinity();
    for (const ScreenVertex& corner : corners)
        of_corners = std::min(
            of_corners,
            slope.at({static_cast<double>(corner.point.x), static_cast<double>(corner.point.y)}));
    double of_square = std::numeric_limits<double>::infinity();
    for (const std::int32_t x : {square.low.x, square.high.x})
        for (const std::int32_t y : {square.low.y, square.high.y})
            of_square =
                std::min(of_square, slope.at({static_cast<double>(x), static_cast<double>(y)}));
    return std::max(of_corners, of_square) - 1 - hidden_margin(slope);
}

double SheetsOfCell::blocked(std::span<const std::uint32_t> triangles, const Square& square) {
    const std::size_t count = triangles.size();
    parent_.resize(count);
    std::iota(parent_.begin(), parent_.end(), 0U);
    ends_here_.assign(count, 0);
    least_.assign(count, std::numeric_limits<double>::infinity());
    for (std::uint32_t i = 0; i < count; ++i)
        if (!sheets_.scene.triangles[triangles[i]].is_shadow())
            join(i, triangles, square);
        else
            ends_here_[i] = 1;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t sheet = root(i);
        ends_here_[sheet] = ends_here_[sheet] | ends_here_[i];
        if (ends_here_[sheet] == 0)
            least_[sheet] = std::min(least_[sheet], least_nearness(triangles[i], square));
    }
    double blocked = -1;
    for (std::uint32_t i = 0; i < count; ++i)
        if (parent_[i] == i && ends_here_[i] == 0)
            blocked = std::max(blocked, least_[i]);
    return blocked;
}

std::span<const std::uint32_t>
SheetsOfCell::nearest(std::span<const std::uint32_t> triangles, std::size_t count) {
    by_nearness_.clear();
    for (const std::uint32_t i : triangles)
        by_nearness_.emplace_back(-nearest_of(sheets_, i), i);
    const auto last = by_nearness_.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(by_nearness_.begin(), last, by_nearness_.end());
    nearest_.clear();
    std::transform(by_nearness_.begin(), last, std::back_inserter(nearest_), [](const auto& near) {
        return near.second;
    });
    std::sort(nearest_.begin(), nearest_.end());
    return nearest_;
}

/// Which triangles hang together with another.
std::vector<std::uint8_t> joined_triangles(const SheetScene& sheets) {
    std::vector<std::uint8_t> joined(sheets.scene.triangles.size());
    for (const EdgeNeighbours& beside : sheets.neighbours)
        if (beside.are_two())
            joined[beside.left] = joined[beside.right] = 1;
    return joined;
}

} // namespace

void block_by_sheets(Cells& cells, const SheetScene& sheets, const CancelFlag* cancel) {
    // Of longer lists, in which joining takes long, the nearest: among the others there is hardly a
    // sheet without a border that hides something that these do not.
    constexpr std::size_t longest = 256;
    const std::vector<std::uint8_t> is_joined = joined_triangles(sheets);
    if (std::find(is_joined.begin(), is_joined.end(), 1) == is_joined.end())
        return;
    std::vector<std::uint32_t> ends(cells.starts.begin() + 1, cells.starts.end());
    const auto block = [&](std::size_t cell, SheetsOfCell& sheets_of_cell) {
        const auto triangles = sheets_of_cell.joined(cells.triangles_of(cell), is_joined);
        if (triangles.size() < 2)
            return;
        const auto per_side = static_cast<std::size_t>(cells.per_side);
        const ScreenPoint low = {
            static_cast<std::int32_t>(cell % per_side) << cells.shift,
            static_cast<std::int32_t>(cell / per_side) << cells.shift};
        const std::int32_t size = std::int32_t{1} << cells.shift;
        const double blocked = sheets_of_cell.blocked(
            triangles.size() > longest ? sheets_of_cell.nearest(triangles, longest) : triangles,
            {low, {low.x + size, low.y + size}});
        if (blocked <= cells.blocked[cell] || cells.hides_nothing_in(cell))
            return;
        cells.blocked[cell] = blocked;
        const auto first = cells.triangles.begin() + cells.starts[cell];
        const auto kept =
            std::remove_if(first, first + ends[cell] - cells.starts[cell], [&](std::uint32_t i) {
                return nearest_of(sheets, i) < blocked;
            });
        ends[cell] = static_cast<std::uint32_t>(kept - cells.triangles.begin());
    };
    parallel_ranges(cells.blocked.size(), 4096, [&](std::size_t first, std::size_t last) {
        stop_if_raised(cancel);
        SheetsOfCell sheets_of_cell(sheets);
        for (std::size_t cell = first; cell < last; ++cell)
            block(cell, sheets_of_cell);
    });
    // Closes the gaps that hidden triangles leave.
    auto kept = cells.triangles.begin();
    for (std::size_t cell = 0; cell < ends.size(); ++cell) {
        const auto first = cells.triangles.begin() + cells.starts[cell];
        const auto last = cells.triangles.begin() + ends[cell];
        cells.starts[cell] = static_cast<std::uint32_t>(kept - cells.triangles.begin());
        kept = kept == first ? last : std::move(first, last, kept);
    }
    cells.starts.back() = static_cast<std::uint32_t>(kept - cells.triangles.begin());
    cells.triangles.erase(kept, cells.triangles.end());
}

} // namespace vera
