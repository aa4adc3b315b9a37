// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/grid_build.h"

#include "vera/accel/cell_overlap.h"
#include "vera/accel/element_records.h"
#include "vera/base/check.h"
#include "vera/math/elementary.h"
#include "vera/scene/bounds.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <numeric>

namespace vera::detail {

std::array<std::int32_t, 3> cell_counts(Vec3 extent, double cells) {
    constexpr double most_on_an_axis = 1 << 20;
    std::array<std::int32_t, 3> counts = {1, 1, 1};
    std::array<bool, 3> flat = {extent.x <= 0, extent.y <= 0, extent.z <= 0};
    // An axis on which cells as long as wide would be longer than the box gets one cell, and the
    // others share what that leaves.
    for (int turn = 0; turn < 3; ++turn) {
        double volume = 1;
        int axes = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (!flat[axis]) {
                volume *= extent[axis];
                ++axes;
            }
        if (axes == 0)
            return counts;
        const double cells_per_unit = power(std::max(cells, 1.0) / volume, 1.0 / axes);
        bool changed = false;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double along = flat[axis] ? 1 : extent[axis] * cells_per_unit;
            counts[axis] = static_cast<std::int32_t>(
                std::clamp(std::floor(along + 0.5), 1.0, most_on_an_axis));
            if (!flat[axis] && along < 1) {
                flat[axis] = true;
                changed = true;
            }
        }
        if (!changed)
            break;
    }
    return counts;
}

namespace {

/// A grid as it is built: elements of cell c are references[starts[c]] to references[starts[c+1]].
struct Draft {
    Grid grid;
    std::vector<std::uint64_t> starts;
    std::vector<std::uint32_t> references;
    std::vector<std::pair<std::uint32_t, std::unique_ptr<Draft>>> inner; ///< by cell, in order
};

using Cell3 = std::array<std::int32_t, 3>;

std::size_t cell_count(const Grid& grid) {
    return static_cast<std::size_t>(grid.counts[0]) * static_cast<std::size_t>(grid.counts[1])
        * static_cast<std::size_t>(grid.counts[2]);
}

std::size_t cell_number(const Grid& grid, const Cell3& cell) {
    const auto x = static_cast<std::size_t>(cell[0]);
    const auto y = static_cast<std::size_t>(cell[1]);
    const auto z = static_cast<std::size_t>(cell[2]);
    return x
        + static_cast<std::size_t>(grid.counts[0])
        * (y + static_cast<std::size_t>(grid.counts[1]) * z);
}

/// The box of the cells from first to last, widened by what rounding may move a cell's border.
Block block_of(const Grid& grid, const Cell3& first, const Cell3& last) {
    Block block;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double lower = grid.box.lower[axis] + grid.cell_size[axis] * first[axis];
        const double upper = grid.box.lower[axis] + grid.cell_size[axis] * (last[axis] + 1);
        block.center[axis] = 0.5 * (lower + upper);
        block.half[axis] = 0.5 * (upper - lower) + 0x1p-44;
    }
    return block;
}

/// Builds the grids of one geometry, level by level.
class Builder {
public:
    Builder(
        GeometryGrids& grids,
        const std::vector<Box3>& boxes,
        const GridSettings& settings,
        const CancelFlag* cancel)
        : grids_(grids)
        , boxes_(boxes)
        , settings_(settings)
        , cancel_(cancel) {}

    /// The grid over all elements, and those within it.
    std::unique_ptr<Draft> draft(const std::vector<std::uint32_t>& elements) const {
        const auto count = static_cast<double>(elements.size());
        const double budget = settings_.references * count;
        auto result = std::make_unique<Draft>();
        result->grid =
            plan(elements, grids_.local_bounds, settings_.density * count, 0.5 * budget).grid;
        list_elements(elements, *result);
        refine(*result, 1, budget);
        return result;
    }

    std::uint32_t append(const Draft& draft, std::size_t level) const {
        VERA_CHECK(grids_.grids.size() < Cell::most);
        const auto number = static_cast<std::uint32_t>(grids_.grids.size());
        const std::size_t first_cell = grids_.cells.size();
        grids_.grids.push_back(draft.grid);
        grids_.grids.back().first_cell = first_cell;
        grids_.cells.resize(first_cell + cell_count(draft.grid));
        grids_.levels = std::max(grids_.levels, level);
        std::size_t next_inner = 0;
        for (std::size_t cell = 0; cell + 1 < draft.starts.size(); ++cell) {
            const std::uint64_t first = draft.starts[cell];
            const std::uint64_t last = draft.starts[cell + 1];
            if (first == last)
                continue;
            if (next_inner < draft.inner.size() && draft.inner[next_inner].first == cell) {
                const std::uint32_t inner = append(*draft.inner[next_inner++].second, level + 1);
                grids_.cells[first_cell + cell].value = Cell::grid_bit | inner;
                continue;
            }
            VERA_CHECK(grids_.lists.size() < Cell::most);
            grids_.cells[first_cell + cell].value = static_cast<std::uint32_t>(grids_.lists.size());
            grids_.lists.push_back(static_cast<std::uint32_t>(last - first));
            grids_.lists.insert(
                grids_.lists.end(),
                draft.references.begin() + static_cast<std::ptrdiff_t>(first),
                draft.references.begin() + static_cast<std::ptrdiff_t>(last));
        }
        return number;
    }

private:
    /// Calls sink(cell number) for every cell between first and last that the shape touches.
    template <typename Sink>
    static void for_each_touched_cell(
        const Grid& grid,
        const CellShape* shape,
        const Cell3& first,
        const Cell3& last,
        const Sink& sink) {
        const Cell3 size = {last[0] - first[0] + 1, last[1] - first[1] + 1, last[2] - first[2] + 1};
        const std::int64_t cells = std::int64_t{size[0]} * size[1] * size[2];
        // Halves of a large range are looked at before their cells.
        if (shape != nullptr && (cells == 1 || cells >= 8)
            && !shape->touches(block_of(grid, first, last)))
            return;
        if (cells == 1) {
            sink(cell_number(grid, first));
            return;
        }
        const std::size_t axis = size[0] >= size[1] && size[0] >= size[2] ? 0
            : size[1] >= size[2]                                          ? 1
                                                                          : 2;
        Cell3 middle = last;
        middle[axis] = first[axis] + size[axis] / 2 - 1;
        for_each_touched_cell(grid, shape, first, middle, sink);
        middle = first;
        middle[axis] = first[axis] + size[axis] / 2;
        for_each_touched_cell(grid, shape, middle, last, sink);
    }

    template <typename Sink>
    void for_each_cell_of(
        std::uint32_t element, const Grid& grid, CellShape& shape, const Sink& sink) const {
        for_each_cell_of(*grids_.geometry, element, boxes_[element], grid, shape, sink);
    }

public:
    /// The same for an element whose bounds are given.
    template <typename Sink>
    static void for_each_cell_of(
        const Geometry& geometry,
        std::uint32_t element,
        const Box3& box,
        const Grid& grid,
        CellShape& shape,
        const Sink& sink) {
        Cell3 first;
        Cell3 last;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // Cells that are touched within rounding count as touched.
            const double margin = 0x1p-44 * grid.cells_per_unit[axis];
            const auto cell_at = [&](double coordinate) {
                return (coordinate - grid.box.lower[axis]) * grid.cells_per_unit[axis];
            };
            const double end = grid.counts[axis];
            const double from = std::floor(cell_at(box.lower[axis]) - margin);
            const double to = std::floor(cell_at(box.upper[axis]) + margin);
            if (!(from < end) || !(to >= 0)) {
                // Beyond the grid: only rounding can do that, of what lies on its border.
                const bool near = from < end + 1 && to >= -1;
                if (!near)
                    return;
            }
            first[axis] = static_cast<std::int32_t>(std::clamp(from, 0.0, end - 1));
            last[axis] = static_cast<std::int32_t>(std::clamp(to, 0.0, end - 1));
        }
        const Element place = element_at(geometry, element);
        const bool is_call = geometry.items[place.item].kind == ItemKind::subscene_call;
        if (is_call || first == last) {
            for_each_touched_cell(grid, nullptr, first, last, sink);
            return;
        }
        shape.assign(place);
        for_each_touched_cell(grid, &shape, first, last, sink);
    }

    static Grid grid_over(const Box3& box, double cells) {
        Grid grid;
        grid.box = box;
        grid.counts = cell_counts(extent(box), std::min(cells, 0x1p30));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // A flat box gets a cell that can be divided by.
            const double size = std::max(extent(box)[axis] / grid.counts[axis], 0x1p-60);
            grid.cell_size[axis] = size;
            grid.cells_per_unit[axis] = 1 / size;
        }
        return grid;
    }

private:
    /// Counts each cell's elements, makes room, and writes them down. Threads may meet in a cell,
    /// so that its list is sorted at the end.
    void list_elements(const std::vector<std::uint32_t>& elements, Draft& draft) const {
        const std::size_t cells = cell_count(draft.grid);
        draft.starts.assign(cells + 1, 0);
        const auto each = [&](const auto& sink) {
            parallel_ranges(elements.size(), 1024, [&](std::size_t first, std::size_t last) {
                if (cancel_ != nullptr)
                    cancel_->throw_if_raised();
                CellShape shape(*grids_.geometry, grids_.center, grids_.scale);
                for (std::size_t i = first; i < last; ++i)
                    for_each_cell_of(elements[i], draft.grid, shape, [&](std::size_t cell) {
                        sink(cell, elements[i]);
                    });
            });
        };
        each([&](std::size_t cell, std::uint32_t) {
            std::atomic_ref(draft.starts[cell + 1]).fetch_add(1, std::memory_order_relaxed);
        });
        std::partial_sum(draft.starts.begin(), draft.starts.end(), draft.starts.begin());
        draft.references.resize(draft.starts.back());
        std::vector<std::uint64_t> next(draft.starts.begin(), draft.starts.end() - 1);
        each([&](std::size_t cell, std::uint32_t element) {
            const std::uint64_t place =
                std::atomic_ref(next[cell]).fetch_add(1, std::memory_order_relaxed);
            draft.references[place] = element;
        });
        parallel_ranges(cells, 4096, [&](std::size_t first, std::size_t last) {
            for (std::size_t cell = first; cell < last; ++cell)
                std::sort(
                    draft.references.begin() + static_cast<std::ptrdiff_t>(draft.starts[cell]),
                    draft.references.begin() + static_cast<std::ptrdiff_t>(draft.starts[cell + 1]));
        });
    }

    struct Plan {
        Grid grid;
        double references = 0; ///< about so many
    };

    /// A grid of about so many cells, or of fewer where their lists would be longer than the
    /// budget.
    Plan
    plan(const std::vector<std::uint32_t>& elements, const Box3& box, double cells, double budget)
        const {
        Plan result;
        for (int turn = 0; turn < 5; ++turn) {
            result.grid = grid_over(box, cells);
            result.references = sampled_references(elements, result.grid);
            if (result.references <= budget || cells <= 1)
                break;
            // Surfaces that are large compared with the cells pass through cells^(2/3) of them.
            const double part = budget / result.references;
            cells = std::max(1.0, 0.9 * cells * part * std::sqrt(part));
        }
        return result;
    }

    double sampled_references(const std::vector<std::uint32_t>& elements, const Grid& grid) const {
        constexpr std::size_t sample_size = 128;
        const std::size_t step = std::max<std::size_t>(elements.size() / sample_size, 1);
        std::size_t sampled = 0;
        std::size_t references = 0;
        CellShape shape(*grids_.geometry, grids_.center, grids_.scale);
        for (std::size_t i = step / 2; i < elements.size(); i += step, ++sampled)
            for_each_cell_of(elements[i], grid, shape, [&](std::size_t) { ++references; });
        return static_cast<double>(references)
            / static_cast<double>(std::max<std::size_t>(sampled, 1))
            * static_cast<double>(elements.size());
    }

    /// Gives crowded cells grids of their own where that pays. What is left of the budget of
    /// references is shared out by the length of the lists.
    void refine(Draft& draft, std::size_t level, double budget) const {
        if (level >= settings_.levels)
            return;
        std::vector<std::uint32_t> crowded;
        std::uint64_t in_crowds = 0;
        for (std::size_t cell = 0; cell + 1 < draft.starts.size(); ++cell) {
            const std::uint64_t length = draft.starts[cell + 1] - draft.starts[cell];
            if (length < settings_.crowd)
                continue;
            crowded.push_back(static_cast<std::uint32_t>(cell));
            in_crowds += length;
        }
        const double left = budget - static_cast<double>(draft.references.size());
        if (crowded.empty() || !(left > 0))
            return;
        const double each = 1 + left / static_cast<double>(in_crowds);
        std::vector<std::unique_ptr<Draft>> inner(crowded.size());
        parallel_ranges(crowded.size(), 1, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                inner[i] = refined_cell(draft, crowded[i], level + 1, each);
        });
        for (std::size_t i = 0; i < crowded.size(); ++i)
            if (inner[i] != nullptr)
                draft.inner.emplace_back(crowded[i], std::move(inner[i]));
    }

    std::unique_ptr<Draft> refined_cell(
        const Draft& draft, std::uint32_t cell, std::size_t level, double references) const {
        const std::vector<std::uint32_t> elements(
            draft.references.begin() + static_cast<std::ptrdiff_t>(draft.starts[cell]),
            draft.references.begin() + static_cast<std::ptrdiff_t>(draft.starts[cell + 1]));
        const Box3 cell_box = box_of(draft.grid, cell);
        Box3 box;
        for (const std::uint32_t element : elements)
            box = united(box, boxes_[element]);
        box = {max(box.lower, cell_box.lower), min(box.upper, cell_box.upper)};
        if (box.empty())
            return nullptr; // what touches the cell does so within rounding
        const auto count = static_cast<double>(elements.size());
        const double budget = references * count;
        const Plan planned = plan(elements, box, settings_.crowd_density * count, budget);
        if (!pays(planned, cell_box, count))
            return nullptr;
        auto result = std::make_unique<Draft>();
        result->grid = planned.grid;
        list_elements(elements, *result);
        refine(*result, level, budget);
        return result;
    }

    static Box3 box_of(const Grid& grid, std::size_t cell) {
        const auto nx = static_cast<std::size_t>(grid.counts[0]);
        const auto ny = static_cast<std::size_t>(grid.counts[1]);
        const auto x = static_cast<std::int32_t>(cell % nx);
        const auto y = static_cast<std::int32_t>(cell / nx % ny);
        const auto z = static_cast<std::int32_t>(cell / nx / ny);
        const Block block = block_of(grid, {x, y, z}, {x, y, z});
        return {block.center - block.half, block.center + block.half};
    }

    static double surface(Vec3 size) { return size.x * size.y + size.y * size.z + size.z * size.x; }

    /// Whether a ray through the cell has less to do with the inner grid than with the list. A
    /// convex thing in another is met by a part of the lines through that one which is the ratio of
    /// their surfaces.
    static bool pays(const Plan& inner, const Box3& cell_box, double count) {
        constexpr double step_cost = 0.25; // of a slice of cells, in tests of an element
        constexpr double entry_cost = 2;
        const double outer_surface = surface(extent(cell_box));
        if (!(outer_surface > 0))
            return false;
        const Grid& grid = inner.grid;
        const double inner_tests = inner.references * surface(grid.cell_size) / outer_surface;
        const double entering = surface(extent(grid.box)) / outer_surface;
        const double steps =
            step_cost * entering * (grid.counts[0] + grid.counts[1] + grid.counts[2]) / 2;
        return entry_cost + steps + inner_tests < 0.7 * count;
    }

    GeometryGrids& grids_;
    const std::vector<Box3>& boxes_;
    const GridSettings& settings_;
    const CancelFlag* cancel_;
};

} // namespace

std::size_t forecast_bytes(
    const Geometry& geometry,
    const std::vector<Box3>& subscene_bounds,
    const GridSettings& settings) {
    const LocalGeometry local = local_geometry(geometry, subscene_bounds);
    if (local.bounds.empty())
        return 0;
    const auto count = static_cast<double>(geometry.element_count);
    const Grid grid = Builder::grid_over(local.local_bounds, settings.density * count);
    constexpr std::uint64_t sample_size = 256;
    const std::uint64_t step = std::max<std::uint64_t>(geometry.element_count / sample_size, 1);
    CellShape shape(geometry, local.center, local.scale);
    double sampled = 0;
    double touched = 0;
    for (std::uint64_t i = step / 2; i < geometry.element_count; i += step, ++sampled) {
        const Box3 box = local_box(local, element_at(geometry, i), subscene_bounds);
        if (!box.empty())
            Builder::for_each_cell_of(
                geometry, static_cast<std::uint32_t>(i), box, grid, shape, [&](std::size_t) {
                    ++touched;
                });
    }
    const double budget = settings.references * count;
    const double outer = std::min(0.5 * budget, touched / std::max(sampled, 1.0) * count);
    const auto cells = static_cast<double>(cell_count(grid));
    // What crowded cells will add is not known before: as much again as the outer grid is typical.
    const double all_references = std::min(budget, 2.5 * outer);
    const double all_cells = cells + settings.crowd_density * count;
    const double lasting = count * sizeof(ElementRecord) + all_cells * sizeof(Cell)
        + (all_cells + all_references) * sizeof(std::uint32_t)
        + static_cast<double>(most_memory_of_outline_table(geometry));
    const double passing = count * (sizeof(Box3) + sizeof(std::uint32_t))
        + all_cells * 2 * sizeof(std::uint64_t) + all_references * sizeof(std::uint32_t);
    return static_cast<std::size_t>(lasting + passing);
}

GeometryGrids build_geometry_grids(
    const Geometry& geometry,
    const std::vector<Box3>& subscene_bounds,
    const GridSettings& settings,
    const CancelFlag* cancel) {
    GeometryGrids grids;
    static_cast<LocalGeometry&>(grids) = local_geometry(geometry, subscene_bounds);
    if (grids.bounds.empty())
        return grids;
    grids.outlines = outline_table(geometry);

    const auto count = static_cast<std::size_t>(geometry.element_count);
    std::vector<Box3> boxes(count);
    grids.records.resize(count);
    parallel_ranges(count, 1024, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const Element element = element_at(geometry, i);
            boxes[i] = local_box(grids, element, subscene_bounds);
            grids.records[i] = element_record(grids, element, boxes[i]);
        }
    });

    std::vector<std::uint32_t> elements;
    for (std::size_t i = 0; i < count; ++i)
        if (!boxes[i].empty()) // calls of empty subscenes
            elements.push_back(static_cast<std::uint32_t>(i));
    const Builder builder(grids, boxes, settings, cancel);
    const auto draft = builder.draft(elements);
    grids.lists.push_back(0); // place 0 means an empty cell
    builder.append(*draft, 1);
    return grids;
}

} // namespace vera::detail
