// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/cells.h"

#include "vera/base/long_loop.h"
#include "vera/visible/hidden_squares.h"
#include "vera/visible/sheets.h"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace vera {

namespace {

/// Not more than how near the plane is at any point of the cell.
double least_nearness(const Cells& cells, const NearnessSlope& slope, ScreenPoint lower) {
    const auto size = static_cast<double>(std::int64_t{1} << cells.shift);
    double least = std::numeric_limits<double>::infinity();
    for (const double x : {0.0, size})
        for (const double y : {0.0, size})
            least = std::min(least, slope.at({lower.x + x, lower.y + y}));
    // Within a triangle the terms of at() are at most 2^34, for slivers far more; but those cover
    // no cell.
    return least - 1;
}

/// Whether the triangle is as wide and high as so many cells.
bool is_as_large_as(
    std::int32_t count, const std::array<ScreenVertex, 3>& corners, const Cells& cells) {
    const std::int64_t least = std::int64_t{count} << cells.shift;
    const auto reaches = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
        return std::max({a, b, c}) - std::min({a, b, c}) >= least;
    };
    return reaches(corners[0].point.x, corners[1].point.x, corners[2].point.x)
        && reaches(corners[0].point.y, corners[1].point.y, corners[2].point.y);
}

/// Of these cells, which are asked for: those of which a quarter is.
std::vector<std::uint8_t>
in_larger_cells(const std::vector<std::uint8_t>& asked_quarters, const Cells& cells) {
    std::vector<std::uint8_t> asked(asked_quarters.size() / 4);
    const std::int32_t quarters_per_side = 2 * cells.per_side;
    std::size_t quarter = 0;
    for (std::int32_t row = 0; row < quarters_per_side; ++row)
        for (std::int32_t column = 0; column < quarters_per_side; ++column, ++quarter) {
            std::uint8_t& cell = asked[cells.number(column / 2, row / 2)];
            cell = std::max(cell, asked_quarters[quarter]);
        }
    return asked;
}

int shift_for(std::size_t triangles) {
    // One and a half to six cells a triangle. With more, edges are compared with less, and the
    // lists take longer to make: scattered triangles would take more, closed bodies fewer.
    int bits = 1;
    const double least = 1.5 * static_cast<double>(triangles);
    while (bits < screen_bits - 4 && std::ldexp(1.0, 2 * bits) < least)
        ++bits;
    return screen_bits - bits;
}

/// Puts the triangles of a scene into cells. Threads share the rows of cells, so that each list is
/// written by one of them, in order.
class CellLists {
public:
    CellLists(
        const ScreenScene& scene,
        std::span<const NearnessSlope> slopes,
        const CancelFlag* cancel,
        const AskedCells& asked,
        const SheetScene* sheets);

    Cells cells();

private:
    static constexpr std::size_t group = 64; ///< triangles, which lie near each other

    /// Rows of cells, none where last < first.
    struct Reach {
        std::int32_t first = std::numeric_limits<std::int32_t>::max();
        std::int32_t last = -1;

        void include(Reach other) {
            first = std::min(first, other.first);
            last = std::max(last, other.last);
        }
    };

    /// Calls visit(triangle, row, RowOfCells) for the rows that triangles touch, of those of which
    /// does_matter(number, corners) is true: triangle by triangle within a row, in several rows at
    /// once.
    template <typename DoesMatter, typename Visit>
    void for_each_row(const Cells& cells, const DoesMatter& does_matter, const Visit& visit) const;

    /// Calls visit(cell, triangle) for the triangles of each cell that are not hidden there, of
    /// those of which does_matter(number, corners) is true.
    template <typename DoesMatter, typename Visit>
    void
    for_each_entry(const Cells& cells, const DoesMatter& does_matter, const Visit& visit) const;

    template <typename DoesMatter>
    std::uint64_t count_entries(Cells& cells, const DoesMatter& does_matter) const;
    template <typename DoesMatter>
    void fill_lists(Cells& cells, const DoesMatter& does_matter) const;

    /// Shadows are in no list.
    auto is_surface() const {
        return [this](std::size_t i, const auto&) { return !scene_.triangles[i].is_shadow(); };
    }

    std::uint64_t most_entries() const { return 64 * std::uint64_t{nearness_.size()} + 65536; }

    void ask(const Cells& cells);
    template <typename ReachOf>
    void find_reaches(const ReachOf& reach_of);
    void block(Cells& cells) const;
    void block_by_large_sheets(Cells& cells) const;
    bool block_by_sheets_of(const std::vector<std::uint8_t>& matter, Cells& cells) const;
    void unblock(Cells& cells) const;
    void leave_out_hidden(const Cells& cells);
    std::uint64_t count(Cells& cells);

    const ScreenScene& scene_;
    std::span<const NearnessSlope> slopes_;
    const CancelFlag* cancel_;
    const AskedCells& asked_;
    const SheetScene* sheets_;
    std::vector<std::uint8_t> asked_cells_; ///< as AskedCell; empty: all are asked for
    std::vector<std::uint8_t> matters_; ///< of triangles, whether they may be in such a cell's list
    std::vector<double> nearness_;      ///< of triangles, for hiding
    std::vector<Reach> reaches_;        ///< of triangles, from where to where cells are asked for
    std::vector<Reach> group_reaches_;  ///< of groups, of all their triangles
};

CellLists::CellLists(
    const ScreenScene& scene,
    std::span<const NearnessSlope> slopes,
    const CancelFlag* cancel,
    const AskedCells& asked,
    const SheetScene* sheets)
    : scene_(scene)
    , slopes_(slopes)
    , cancel_(cancel)
    , asked_(asked)
    , sheets_(sheets)
    , matters_(scene.triangles.size())
    , nearness_(scene.triangles.size())
    , reaches_(scene.triangles.size())
    , group_reaches_((scene.triangles.size() + group - 1) / group) {
    parallel_ranges(group_reaches_.size(), 64, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first * group; i < std::min(last * group, nearness_.size()); ++i) {
            const auto corners = corners_of(scene_, scene_.triangles[i]);
            nearness_[i] = nearest_for_hiding(
                slopes_[i], std::array{corners[0].point, corners[1].point, corners[2].point});
        }
    });
}

template <typename DoesMatter, typename Visit>
void CellLists::for_each_row(
    const Cells& cells, const DoesMatter& does_matter, const Visit& visit) const {
    // A triangle is begun anew in each band: not in every few rows.
    constexpr std::int32_t most_bands = 64;
    constexpr std::int32_t least_rows = 16;
    const std::int32_t bands = std::clamp(cells.per_side / least_rows, 1, most_bands);
    const std::int32_t height = cells.per_side / bands;
    parallel_ranges(static_cast<std::size_t>(bands), 1, [&](std::size_t number, std::size_t) {
        const std::int32_t first = static_cast<std::int32_t>(number) * height;
        const std::int32_t last = first + height - 1;
        for (std::size_t in = 0; in < group_reaches_.size(); ++in) {
            stop_if_raised(cancel_);
            if (group_reaches_[in].last < first || group_reaches_[in].first > last)
                continue;
            for (std::size_t i = in * group; i < std::min((in + 1) * group, nearness_.size());
                 ++i) {
                const Reach& reach = reaches_[i];
                if (matters_[i] == 0 || reach.last < first || reach.first > last)
                    continue;
                const auto corners = corners_of(scene_, scene_.triangles[i]);
                if (!does_matter(i, corners))
                    continue;
                RowsOfCells rows(
                    cells, corners, std::max(first, reach.first), std::min(last, reach.last));
                for (std::int32_t row = rows.first(); row <= rows.last(); ++row)
                    visit(static_cast<std::uint32_t>(i), row, rows.next());
            }
        }
    });
}

template <typename DoesMatter, typename Visit>
void CellLists::for_each_entry(
    const Cells& cells, const DoesMatter& does_matter, const Visit& visit) const {
    for_each_row(
        cells, does_matter, [&](std::uint32_t i, std::int32_t row, const RowOfCells& found) {
            for (std::int32_t j = found.touched.first; j <= found.touched.last; ++j)
                if (const std::size_t cell = cells.number(j, row);
                    nearness_[i] >= cells.blocked[cell])
                    visit(cell, i);
        });
}

/// Counts the triangles of each list into starts, two places farther on; returns how many there are
/// in all.
template <typename DoesMatter>
std::uint64_t CellLists::count_entries(Cells& cells, const DoesMatter& does_matter) const {
    cells.starts.assign(cells.blocked.size() + 2, 0);
    for_each_entry(
        cells, does_matter, [&](std::size_t cell, std::uint32_t) { ++cells.starts[cell + 2]; });
    return std::accumulate(cells.starts.begin(), cells.starts.end(), std::uint64_t{0});
}

/// Fills lists that were counted.
template <typename DoesMatter>
void CellLists::fill_lists(Cells& cells, const DoesMatter& does_matter) const {
    std::partial_sum(cells.starts.begin(), cells.starts.end(), cells.starts.begin());
    cells.triangles.resize(cells.starts.back());
    // Each list grows from where the one before it ends, until it ends where the next begins.
    for_each_entry(cells, does_matter, [&](std::size_t cell, std::uint32_t i) {
        cells.triangles[cells.starts[cell + 1]++] = i;
    });
    cells.starts.pop_back();
}

/// reach_of(corners) of the triangles, and of the groups; those that have none do not matter.
template <typename ReachOf>
void CellLists::find_reaches(const ReachOf& reach_of) {
    parallel_ranges(group_reaches_.size(), 64, [&](std::size_t first, std::size_t last) {
        std::fill(group_reaches_.data() + first, group_reaches_.data() + last, Reach{});
        for (std::size_t i = first * group; i < std::min(last * group, nearness_.size()); ++i) {
            reaches_[i] = reach_of(corners_of(scene_, scene_.triangles[i]));
            matters_[i] = reaches_[i].first <= reaches_[i].last ? 1 : 0;
            if (matters_[i] != 0)
                group_reaches_[i / group].include(reaches_[i]);
        }
    });
}

/// Finds which cells are asked for, and which triangles matter therefore: where few are, most need
/// not be followed from row to row.
void CellLists::ask(const Cells& cells) {
    const auto rows_of = [&](const std::array<ScreenVertex, 3>& corners) {
        const auto [low, high] =
            std::minmax({corners[0].point.y, corners[1].point.y, corners[2].point.y});
        return Reach{cells.cell_of(low), cells.cell_of(high)};
    };
    if (!asked_)
        return find_reaches(rows_of);
    asked_cells_ = asked_cells_.empty() ? asked_(cells) : in_larger_cells(asked_cells_, cells);
    const CellsInRows asked_in_rows(cells, asked_cells_);
    find_reaches([&](const std::array<ScreenVertex, 3>& corners) {
        const auto [left, right] =
            std::minmax({corners[0].point.x, corners[1].point.x, corners[2].point.x});
        // RowsOfCells may tell what is a step beside the triangle.
        const Columns columns = {cells.cell_of(std::max(left - 2, 0)), cells.cell_of(right + 2)};
        const auto is_asked = [&](std::int32_t row) { return asked_in_rows.are_any(columns, row); };
        Reach reach = rows_of(corners);
        while (reach.first <= reach.last && !is_asked(reach.first))
            ++reach.first;
        while (reach.first < reach.last && !is_asked(reach.last))
            --reach.last;
        return reach;
    });
}

/// Fills in what blocks each cell.
void CellLists::block(Cells& cells) const {
    for_each_row(
        cells,
        [&](std::size_t i, const auto& corners) {
            return !scene_.triangles[i].is_shadow() && is_as_large_as(1, corners, cells);
        },
        [&](std::uint32_t i, std::int32_t row, const RowOfCells& found) {
            for (std::int32_t j = found.covered.first; j <= found.covered.last; ++j) {
                double& blocked = cells.blocked[cells.number(j, row)];
                const ScreenPoint lower = {j << cells.shift, row << cells.shift};
                blocked = std::max(
                    blocked, least_nearness(cells, slopes_[i], lower) - hidden_margin(slopes_[i]));
            }
        });
}

/// A polygon far larger than cells comes as several triangles, and no one of them covers a cell on
/// the border of two. What lies behind there would be in its list in vain, and might be much.
void CellLists::block_by_large_sheets(Cells& cells) const {
    if (sheets_ == nullptr)
        return;
    const auto is_joined = [&](std::uint32_t edge) { return sheets_->neighbours[edge].are_two(); };
    std::vector<std::uint8_t> is_large(nearness_.size());
    parallel_ranges(is_large.size(), 4096, [&](std::size_t first, std::size_t last) {
        constexpr std::int32_t least = 8; // cells, so that lists of these take little time
        for (std::size_t i = first; i < last; ++i)
            is_large[i] = !scene_.triangles[i].is_shadow()
                    && is_as_large_as(least, corners_of(scene_, scene_.triangles[i]), cells)
                    && std::ranges::any_of(sheets_->edges.of_triangle[i], is_joined)
                ? 1
                : 0;
    });
    if (std::ranges::find(is_large, 1) == is_large.end() || block_by_sheets_of(is_large, cells))
        return;
    // So many lie one behind the other that their lists would be too long: the nearest ones first,
    // behind which most of the others are hidden.
    std::vector<std::uint32_t> nearest_first;
    for (std::uint32_t i = 0; i < is_large.size(); ++i)
        if (is_large[i] != 0)
            nearest_first.push_back(i);
    std::sort(nearest_first.begin(), nearest_first.end(), [&](std::uint32_t a, std::uint32_t b) {
        return nearness_[a] != nearness_[b] ? nearness_[a] > nearness_[b] : a < b;
    });
    std::vector<std::uint8_t> matter(is_large.size());
    std::size_t count = 64;
    for (std::size_t first = 0; first < nearest_first.size(); first += count, count *= 2) {
        const std::size_t last = std::min(first + count, nearest_first.size());
        const auto next = std::span(nearest_first).subspan(first, last - first);
        for (const std::uint32_t i : next)
            matter[i] = 1;
        block_by_sheets_of(matter, cells);
        for (const std::uint32_t i : next)
            matter[i] = 0;
    }
}

/// By the sheets of the triangles that matter; false, and by none, where their lists would be too
/// long.
bool CellLists::block_by_sheets_of(const std::vector<std::uint8_t>& matter, Cells& cells) const {
    const auto does_matter = [&](std::size_t i, const auto&) { return matter[i] != 0; };
    Cells some = {cells.shift, cells.per_side, {}, {}, std::move(cells.blocked), {}};
    const bool are_few = count_entries(some, does_matter) <= most_entries();
    if (are_few) {
        fill_lists(some, does_matter);
        block_by_sheets(some, *sheets_, cancel_);
    }
    cells.blocked = std::move(some.blocked);
    return are_few;
}

/// The cells that are asked for with what is hidden there.
void CellLists::unblock(Cells& cells) const {
    if (std::ranges::find(asked_cells_, asked_with_hidden) == asked_cells_.end())
        return;
    cells.hides_nothing.assign(asked_cells_.size(), 0);
    for (std::size_t cell = 0; cell < asked_cells_.size(); ++cell)
        if (asked_cells_[cell] == asked_with_hidden) {
            cells.hides_nothing[cell] = 1;
            cells.blocked[cell] = -1;
        }
}

/// Of the triangles that matter, those that are hidden in all of their cells no more do.
void CellLists::leave_out_hidden(const Cells& cells) {
    const HiddenSquares squares(cells);
    parallel_ranges(matters_.size(), 4096, [&](std::size_t first, std::size_t last) {
        stop_if_raised(cancel_);
        for (std::size_t i = first; i < last; ++i) {
            if (matters_[i] == 0 || scene_.triangles[i].is_shadow())
                continue;
            const auto corners = corners_of(scene_, scene_.triangles[i]);
            if (squares.hide(
                    nearness_[i], std::array{corners[0].point, corners[1].point, corners[2].point}))
                matters_[i] = 0;
        }
    });
}

/// Blocks cells of that size, and counts the triangles of each, as count_entries().
std::uint64_t CellLists::count(Cells& cells) {
    cells.per_side = std::int32_t{1} << (screen_bits - cells.shift);
    const std::size_t number =
        static_cast<std::size_t>(cells.per_side) * static_cast<std::size_t>(cells.per_side);
    cells.blocked.assign(number, -1);
    ask(cells);
    block(cells);
    for (std::size_t cell = 0; cell < asked_cells_.size(); ++cell)
        if (asked_cells_[cell] == not_asked)
            cells.blocked[cell] = std::numeric_limits<double>::infinity();
    block_by_large_sheets(cells);
    unblock(cells);
    leave_out_hidden(cells);
    return count_entries(cells, is_surface());
}

Cells CellLists::cells() {
    Cells cells;
    cells.shift = shift_for(static_cast<std::size_t>(std::count_if(
        scene_.triangles.begin(), scene_.triangles.end(), [](const ScreenTriangle& triangle) {
            return !triangle.is_shadow();
        })));
    while (count(cells) > most_entries())
        ++cells.shift; // with one cell there are as many as triangles
    fill_lists(cells, is_surface());
    return cells;
}

} // namespace

CellsInRows::CellsInRows(const Cells& cells, const std::vector<std::uint8_t>& is_marked)
    : row_size_(static_cast<std::size_t>(cells.per_side) + 1)
    , before_(row_size_ * (row_size_ - 1)) {
    for (std::size_t cell = 0, place = 0; cell < is_marked.size(); ++cell, ++place) {
        if ((place + 1) % row_size_ == 0)
            ++place;
        before_[place + 1] = before_[place] + (is_marked[cell] == 0 ? 0 : 1);
    }
}

RowsOfCells::RowsOfCells(
    const Cells& cells,
    const std::array<ScreenVertex, 3>& corners,
    std::int32_t first,
    std::int32_t last)
    : cells_(cells)
    , corners_(corners)
    , per_cell_(1 / static_cast<double>(std::int64_t{1} << cells.shift)) {
    const auto [lowest, highest] =
        std::minmax({corners[0].point.y, corners[1].point.y, corners[2].point.y});
    first_ = std::max(cells.cell_of(lowest), first);
    last_ = std::min(cells.cell_of(highest), last);
    for (std::size_t i = 0; i < 3; ++i) {
        const ScreenStep side = step(corners[i].point, corners[(i + 1) % 3].point);
        slopes_[i] = static_cast<double>(side.x) / static_cast<double>(side.y);
    }
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
            chord.include(a.x + slopes_[i] * static_cast<double>(y - a.y));
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
    // Between the chords' ends the sides bulge outward. There is nothing beyond the picture's
    // border.
    const double from = std::max(below.left, above.left);
    const double to = std::min(below.right, above.right);
    const double left = column(from == 0 ? from : from + 1);
    const double right = column(to == screen_size ? to : to - 1);
    if (left < right)
        result.covered = {
            static_cast<std::int32_t>(std::max(std::ceil(left), 0.0)),
            static_cast<std::int32_t>(std::min<double>(std::floor(right), cells_.per_side)) - 1};
    return result;
}

Cells cells_of(
    const ScreenScene& scene,
    std::span<const NearnessSlope> slopes,
    const CancelFlag* cancel,
    const AskedCells& asked,
    const SheetScene* sheets) {
    return CellLists(scene, slopes, cancel, asked, sheets).cells();
}

Cells cells_of(const ScreenScene& scene, const CancelFlag* cancel) {
    return cells_of(scene, slopes_of(scene), cancel);
}

} // namespace vera
