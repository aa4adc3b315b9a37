// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/cells.h"

#include <array>
#include <cmath>
#include <limits>

namespace vera {

namespace {

/// Not more than how near the plane is at any point of the cell.
double least_nearness(const Cells& cells, const DepthPlane& plane, ScreenPoint lower) {
    const auto size = static_cast<double>(std::int64_t{1} << cells.shift);
    double least = std::numeric_limits<double>::infinity();
    for (const double x : {0.0, size})
        for (const double y : {0.0, size})
            least = std::min(least, plane.value(lower.x + x, lower.y + y));
    // Within a triangle the terms of value() are at most 2^34, for slivers far more; but those
    // cover no cell.
    return least - 1;
}

/// Whether the triangle is as wide and high as a cell.
bool may_cover_a_cell(const std::array<ScreenVertex, 3>& corners, const Cells& cells) {
    const auto reaches = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
        return std::max({a, b, c}) - std::min({a, b, c}) >= std::int32_t{1} << cells.shift;
    };
    return reaches(corners[0].point.x, corners[1].point.x, corners[2].point.x)
        && reaches(corners[0].point.y, corners[1].point.y, corners[2].point.y);
}

int shift_for(std::size_t triangles) {
    // Two to four cells a side for the root of their number: the optimum is flat.
    int bits = 1;
    while (bits < screen_bits - 4 && std::ldexp(1.0, 2 * bits) < 4 * static_cast<double>(triangles))
        ++bits;
    return screen_bits - bits;
}

/// Fills in what blocks each cell.
void block_cells(
    Cells& cells,
    const ScreenScene& scene,
    std::span<const DepthPlane> planes,
    std::span<const NearnessSlope> slopes) {
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const auto corners = corners_of(scene, scene.triangles[i]);
        if (scene.triangles[i].is_shadow() || !may_cover_a_cell(corners, cells))
            continue;
        for_each_row_of(cells, corners, [&](std::int32_t row, const RowOfCells& found) {
            for (std::int32_t j = found.covered.first; j <= found.covered.last; ++j) {
                double& blocked = cells.blocked[cells.number(j, row)];
                const ScreenPoint lower = {j << cells.shift, row << cells.shift};
                blocked = std::max(
                    blocked, least_nearness(cells, planes[i], lower) - hidden_margin(slopes[i]));
            }
        });
    }
}

/// Calls visit(cell, triangle) for the triangles of each cell that are not hidden there.
template <typename Visit>
void for_each_entry(
    const Cells& cells,
    const ScreenScene& scene,
    std::span<const NearnessSlope> slopes,
    const CancelFlag* cancel,
    const Visit& visit) {
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
        if (cancel != nullptr && i % 256 == 0)
            cancel->throw_if_raised();
        if (scene.triangles[i].is_shadow())
            continue;
        const auto corners = corners_of(scene, scene.triangles[i]);
        const double near = nearest_for_hiding(
            slopes[i], std::array{corners[0].point, corners[1].point, corners[2].point});
        for_each_row_of(cells, corners, [&](std::int32_t row, const RowOfCells& found) {
            for (std::int32_t j = found.touched.first; j <= found.touched.last; ++j)
                if (const std::size_t cell = cells.number(j, row); near >= cells.blocked[cell])
                    visit(cell, i);
        });
    }
}

/// Counts the triangles of each cell of that size into starts; returns how many there are in all.
std::uint64_t count_entries(
    Cells& cells,
    const ScreenScene& scene,
    std::span<const DepthPlane> planes,
    std::span<const NearnessSlope> slopes,
    const CancelFlag* cancel) {
    cells.per_side = std::int32_t{1} << (screen_bits - cells.shift);
    const std::size_t count =
        static_cast<std::size_t>(cells.per_side) * static_cast<std::size_t>(cells.per_side);
    cells.blocked.assign(count, -1);
    cells.starts.assign(count + 1, 0);
    block_cells(cells, scene, planes, slopes);
    std::uint64_t entries = 0;
    for_each_entry(cells, scene, slopes, cancel, [&](std::size_t cell, std::uint32_t) {
        ++cells.starts[cell + 1];
        ++entries;
    });
    return entries;
}

} // namespace

RowsOfCells::RowsOfCells(const Cells& cells, const std::array<ScreenVertex, 3>& corners)
    : cells_(cells)
    , corners_(corners)
    , per_cell_(1 / static_cast<double>(std::int64_t{1} << cells.shift)) {
    const auto [lowest, highest] =
        std::minmax({corners[0].point.y, corners[1].point.y, corners[2].point.y});
    first_ = cells.cell_of(lowest);
    last_ = cells.cell_of(highest);
    y_ = std::int64_t{first_} << cells.shift;
    at_y_ = chord_at(y_);
}

/// Of the triangle with the line at that height; off by less than a step.
RowsOfCells::Chord RowsOfCells::chord_at(std::int64_t y) const {
    Chord chord;
    for (std::size_t i = 0; i < 3; ++i) {
        const ScreenPoint a = corners_[i].point;
        const ScreenPoint b = corners_[(i + 1) % 3].point;
        if (a.y == y)
            chord.include(a.x);
        if ((a.y < y && b.y > y) || (a.y > y && b.y < y))
            chord.include(
                a.x
                + static_cast<double>(b.x - a.x) * static_cast<double>(y - a.y)
                    / static_cast<double>(b.y - a.y));
    }
    return chord;
}

RowOfCells RowsOfCells::next() {
    const Chord below = at_y_;
    const std::int64_t low = y_;
    y_ += std::int64_t{1} << cells_.shift;
    const Chord above = at_y_ = chord_at(y_);
    Chord all = below;
    all.left = std::min(all.left, above.left);
    all.right = std::max(all.right, above.right);
    for (const ScreenVertex& corner : corners_)
        if (corner.point.y >= low && corner.point.y <= y_)
            all.include(corner.point.x);
    RowOfCells result;
    const auto column = [&](double x) { return x * per_cell_; };
    const double first = column(all.left - 1);
    const double last = column(all.right + 1);
    if (!(first <= last))
        return result;
    const auto within = [&](double place) {
        return static_cast<std::int32_t>(std::clamp<double>(place, 0, cells_.per_side - 1));
    };
    result.touched = {within(first), within(last)};
    // Between the chords' ends the sides bulge outward.
    const double left = column(std::max(below.left, above.left) + 1);
    const double right = column(std::min(below.right, above.right) - 1);
    if (left < right)
        result.covered = {
            static_cast<std::int32_t>(std::max(std::ceil(left), 0.0)),
            static_cast<std::int32_t>(std::min<double>(std::floor(right), cells_.per_side)) - 1};
    return result;
}

Cells cells_of(
    const ScreenScene& scene,
    std::span<const DepthPlane> planes,
    std::span<const NearnessSlope> slopes,
    const CancelFlag* cancel) {
    Cells cells;
    const auto is_surface = [](const ScreenTriangle& triangle) { return !triangle.is_shadow(); };
    cells.shift = shift_for(static_cast<std::size_t>(
        std::count_if(scene.triangles.begin(), scene.triangles.end(), is_surface)));
    const std::uint64_t most = 64 * std::uint64_t{scene.triangles.size()} + 65536;
    while (count_entries(cells, scene, planes, slopes, cancel) > most)
        ++cells.shift; // with one cell there are as many as triangles
    for (std::size_t i = 1; i < cells.starts.size(); ++i)
        cells.starts[i] += cells.starts[i - 1];
    cells.triangles.resize(cells.starts.back());
    std::vector<std::uint32_t> next(cells.starts.begin(), cells.starts.end() - 1);
    for_each_entry(cells, scene, slopes, cancel, [&](std::size_t cell, std::uint32_t i) {
        cells.triangles[next[cell]++] = i;
    });
    return cells;
}

Cells cells_of(const ScreenScene& scene, const CancelFlag* cancel) {
    std::vector<DepthPlane> planes;
    std::vector<NearnessSlope> slopes;
    planes.reserve(scene.triangles.size());
    slopes.reserve(scene.triangles.size());
    for (const ScreenTriangle& triangle : scene.triangles) {
        planes.push_back(plane_of(scene, triangle));
        slopes.push_back(nearness_slope(planes.back()));
    }
    return cells_of(scene, planes, slopes, cancel);
}

} // namespace vera
