// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/cells.h"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace vera {

namespace {

/// Not more than how near the plane is at any point of the cell.
double least_nearness(const Cells::Grid& grid, const DepthPlane& plane, ScreenPoint lower) {
    const auto size = static_cast<double>(std::int64_t{1} << grid.shift);
    double least = std::numeric_limits<double>::infinity();
    for (const double x : {0.0, size})
        for (const double y : {0.0, size})
            least = std::min(least, plane.value(lower.x + x, lower.y + y));
    // Within a triangle the terms of value() are at most 2^34, for slivers far more; but those
    // cover no cell.
    return least - 1;
}

double nearest(const std::array<ScreenVertex, 3>& corners) {
    return static_cast<double>(
        std::max({corners[0].nearness, corners[1].nearness, corners[2].nearness}));
}

/// Whether the triangle is as wide and high as a cell.
bool may_cover_a_cell(const std::array<ScreenVertex, 3>& corners, const Cells::Grid& grid) {
    const auto reaches = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
        return std::max({a, b, c}) - std::min({a, b, c}) >= std::int32_t{1} << grid.shift;
    };
    return reaches(corners[0].point.x, corners[1].point.x, corners[2].point.x)
        && reaches(corners[0].point.y, corners[1].point.y, corners[2].point.y);
}

int bits_for(std::size_t triangles) {
    // Two to four cells a side for the root of their number: the optimum is flat.
    int bits = 1;
    while (bits < screen_bits - 4 && std::ldexp(1.0, 2 * bits) < 4 * static_cast<double>(triangles))
        ++bits;
    return bits;
}

/// Makes cells of triangles, grid by grid.
class CellMaker {
public:
    CellMaker(
        const ScreenScene& scene,
        std::span<const DepthPlane> planes,
        std::span<const NearnessSlope> slopes,
        const CancelFlag* cancel)
        : scene_(scene)
        , planes_(planes)
        , slopes_(slopes)
        , cancel_(cancel)
        , most_entries_(64 * std::uint64_t{scene.triangles.size()} + 65536) {}

    Cells cells();

private:
    /// A grid in work.
    struct Task {
        Cells::Grid grid; ///< first_cell is 0 until it is added
        std::vector<std::uint32_t> of; ///< the triangles that may touch it
        double blocked_before = -1;
        std::uint32_t cut_cell = Cells::no_grid; ///< the cell that it cuts again

        // Of its cells, as in Cells.
        std::vector<std::uint32_t> starts = {};
        std::vector<std::uint32_t> triangles = {};
        std::vector<double> blocked = {};

        /// As they are counted, before starts are added up.
        std::uint64_t entries() const {
            return std::accumulate(starts.begin(), starts.end(), std::uint64_t{0});
        }
    };

    static constexpr int smallest_shift = 6;

    void block(Task& task) const;
    template <typename Visit>
    void for_each_entry(const Task& task, const Visit& visit) const;
    bool count(Task& task, std::uint64_t most) const;
    void fill(Task& task) const;
    Task cut_again(const Task& task, std::uint32_t cell) const;
    void add(const Task& task);

    const ScreenScene& scene_;
    std::span<const DepthPlane> planes_;
    std::span<const NearnessSlope> slopes_;
    const CancelFlag* cancel_;
    std::uint64_t most_entries_;
    std::uint64_t entries_ = 0; ///< of all grids
    Cells cells_;
    std::vector<Task> tasks_; ///< that are counted and to be added
};

/// Fills in what blocks each cell.
void CellMaker::block(Task& task) const {
    const Cells::Grid& grid = task.grid;
    task.blocked.assign(std::size_t{1} << static_cast<unsigned>(2 * grid.bits), task.blocked_before);
    for (const std::uint32_t i : task.of) {
        const auto corners = corners_of(scene_, scene_.triangles[i]);
        if (scene_.triangles[i].is_shadow() || !may_cover_a_cell(corners, grid))
            continue;
        const auto block_row = [&](std::int32_t row, const RowOfCells& found) {
            for (std::int32_t j = found.covered.first; j <= found.covered.last; ++j) {
                double& blocked = task.blocked[grid.cell(j, row)];
                const ScreenPoint lower = {
                    grid.low.x + (j << grid.shift), grid.low.y + (row << grid.shift)};
                blocked = std::max(
                    blocked, least_nearness(grid, planes_[i], lower) - hidden_margin(slopes_[i]));
            }
        };
        for_each_row_of(grid, corners, block_row);
    }
}

/// Calls visit(cell, triangle) for the triangles of each cell that are not hidden there.
template <typename Visit>
void CellMaker::for_each_entry(const Task& task, const Visit& visit) const {
    const Cells::Grid& grid = task.grid;
    for (std::size_t number = 0; number < task.of.size(); ++number) {
        if (cancel_ != nullptr && number % 256 == 0)
            cancel_->throw_if_raised();
        const std::uint32_t i = task.of[number];
        const auto corners = corners_of(scene_, scene_.triangles[i]);
        const double near = nearest(corners) + hidden_margin(slopes_[i]);
        for_each_row_of(grid, corners, [&](std::int32_t row, const RowOfCells& found) {
            for (std::int32_t j = found.touched.first; j <= found.touched.last; ++j)
                if (const std::uint32_t cell = grid.cell(j, row); near >= task.blocked[cell])
                    visit(cell, i);
        });
    }
}

/// Counts the triangles of each cell; false where there are more than `most` together.
bool CellMaker::count(Task& task, std::uint64_t most) const {
    block(task);
    task.starts.assign(task.blocked.size() + 1, 0);
    std::uint64_t entries = 0;
    for_each_entry(task, [&](std::uint32_t cell, std::uint32_t) {
        ++task.starts[cell + 1];
        ++entries;
    });
    return entries <= most;
}

void CellMaker::fill(Task& task) const {
    for (std::size_t i = 1; i < task.starts.size(); ++i)
        task.starts[i] += task.starts[i - 1];
    task.triangles.resize(task.starts.back());
    std::vector<std::uint32_t> next(task.starts.begin(), task.starts.end() - 1);
    for_each_entry(
        task, [&](std::uint32_t cell, std::uint32_t i) { task.triangles[next[cell]++] = i; });
}

CellMaker::Task CellMaker::cut_again(const Task& task, std::uint32_t cell) const {
    Task cut;
    cut.of.assign(
        task.triangles.begin() + task.starts[cell], task.triangles.begin() + task.starts[cell + 1]);
    cut.blocked_before = task.blocked[cell];
    cut.cut_cell = task.grid.first_cell + cell;
    const auto column = static_cast<std::int32_t>(cell & ((1U << static_cast<unsigned>(task.grid.bits)) - 1U));
    const auto row = static_cast<std::int32_t>(cell >> static_cast<unsigned>(task.grid.bits));
    cut.grid.low = {
        task.grid.low.x + (column << task.grid.shift), task.grid.low.y + (row << task.grid.shift)};
    cut.grid.bits = std::min(bits_for(cut.of.size()), task.grid.shift - smallest_shift);
    cut.grid.shift = task.grid.shift - cut.grid.bits;
    return cut;
}

Cells CellMaker::cells() {
    Task whole;
    whole.of.resize(scene_.triangles.size());
    std::iota(whole.of.begin(), whole.of.end(), 0U);
    whole.grid.bits = bits_for(static_cast<std::size_t>(std::count_if(
        scene_.triangles.begin(), scene_.triangles.end(), [](const ScreenTriangle& triangle) {
            return !triangle.is_shadow();
        })));
    whole.grid.shift = screen_bits - whole.grid.bits;
    while (!count(whole, most_entries_)) {
        --whole.grid.bits; // with one cell there are as many as triangles
        ++whole.grid.shift;
    }
    entries_ = whole.entries();
    tasks_.push_back(std::move(whole));
    cells_.starts.push_back(0);
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
        Task task = std::move(tasks_[i]);
        fill(task);
        task.grid.first_cell = static_cast<std::uint32_t>(cells_.blocked.size());
        add(task);
    }
    return std::move(cells_);
}

/// Adds the grid's cells, and the grids that cut those again in which triangles crowd to the tasks.
void CellMaker::add(const Task& task) {
    constexpr std::uint32_t crowd = 32;
    if (task.cut_cell != Cells::no_grid)
        cells_.within[task.cut_cell] = static_cast<std::uint32_t>(cells_.grids.size());
    cells_.grids.push_back(task.grid);
    cells_.blocked.insert(cells_.blocked.end(), task.blocked.begin(), task.blocked.end());
    cells_.within.resize(cells_.blocked.size(), Cells::no_grid);
    for (std::uint32_t cell = 0; cell < task.blocked.size(); ++cell) {
        const std::uint32_t entries = task.starts[cell + 1] - task.starts[cell];
        if (entries > crowd && task.grid.shift > smallest_shift) {
            Task cut = cut_again(task, cell);
            // Where they lie one behind the other it would not help.
            const std::uint64_t most =
                std::min(3 * std::uint64_t{entries}, most_entries_ + entries - entries_);
            if (count(cut, most)) {
                entries_ += cut.entries() - entries;
                tasks_.push_back(std::move(cut));
                cells_.starts.push_back(cells_.starts.back());
                continue;
            }
        }
        cells_.triangles.insert(
            cells_.triangles.end(),
            task.triangles.begin() + task.starts[cell],
            task.triangles.begin() + task.starts[cell + 1]);
        cells_.starts.push_back(static_cast<std::uint32_t>(cells_.triangles.size()));
    }
}

} // namespace

RowsOfCells::RowsOfCells(const Cells::Grid& grid, const std::array<ScreenVertex, 3>& corners)
    : grid_(grid)
    , corners_(corners)
    , per_cell_(1 / static_cast<double>(std::int64_t{1} << grid.shift)) {
    const auto [lowest, highest] =
        std::minmax({corners[0].point.y, corners[1].point.y, corners[2].point.y});
    first_ = grid.place(lowest, grid.low.y);
    last_ = grid.place(highest, grid.low.y);
    y_ = grid.low.y + (std::int64_t{first_} << grid.shift);
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
    y_ += std::int64_t{1} << grid_.shift;
    const Chord above = at_y_ = chord_at(y_);
    Chord all = below;
    all.left = std::min(all.left, above.left);
    all.right = std::max(all.right, above.right);
    for (const ScreenVertex& corner : corners_)
        if (corner.point.y >= low && corner.point.y <= y_)
            all.include(corner.point.x);
    RowOfCells result;
    // In cells from the grid's first one on.
    const auto column = [&](double x) { return (x - grid_.low.x) * per_cell_; };
    const double first = column(all.left - 1);
    const double last = column(all.right + 1);
    if (!(first <= last) || last < 0 || first > grid_.per_side())
        return result;
    const auto within = [&](double place) {
        return static_cast<std::int32_t>(std::clamp<double>(place, 0, grid_.per_side() - 1));
    };
    result.touched = {within(first), within(last)};
    // Between the chords' ends the sides bulge outward.
    const double left = column(std::max(below.left, above.left) + 1);
    const double right = column(std::min(below.right, above.right) - 1);
    if (left < right)
        result.covered = {
            static_cast<std::int32_t>(std::max(std::ceil(left), 0.0)),
            static_cast<std::int32_t>(std::min<double>(std::floor(right), grid_.per_side())) - 1};
    return result;
}

Cells cells_of(
    const ScreenScene& scene,
    std::span<const DepthPlane> planes,
    std::span<const NearnessSlope> slopes,
    const CancelFlag* cancel) {
    return CellMaker(scene, planes, slopes, cancel).cells();
}

Cells cells_of(const ScreenScene& scene, const CancelFlag* cancel) {
    std::vector<DepthPlane> planes;
    std::vector<NearnessSlope> slopes;
    planes.reserve(scene.triangles.size());
    slopes.reserve(scene.triangles.size());
    for (const ScreenTriangle& triangle : scene.triangles) {
        planes.push_back(depth_plane(corners_of(scene, triangle)));
        slopes.push_back(nearness_slope(planes.back()));
    }
    return cells_of(scene, planes, slopes, cancel);
}

} // namespace vera
