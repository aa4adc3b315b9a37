// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/grid_cells.h"

#include "vera/accel/grid_build.h"
#include "vera/accel/index_memory.h"
#include "vera/accel/packet_index.h"
#include "vera/scene/bounds.h"

#include <algorithm>

namespace vera {

namespace {

using detail::Cell;
using detail::GeometryGrids;
using detail::Grid;

/// A grid where it stands: grid number `grid` of geometry number `geometry`, of which 0 is the main
/// scene.
struct PlacedGrid {
    std::size_t geometry = 0;
    std::uint32_t grid = 0;
    Affine3 to_scene; ///< from the geometry's own coordinates
};

class Walk {
public:
    Walk(const Scene& scene, const std::vector<GeometryGrids>& made, std::size_t most_cells)
        : scene_(scene)
        , made_(made)
        , most_cells_(most_cells) {}

    /// The levels down to the deepest one; cells as far as they are not too many.
    GridCells down_to(std::size_t deepest, const CancelFlag* cancel) {
        result_ = {};
        if (made_.front().grids.empty())
            return result_;
        const Grid& top = made_.front().grids.front();
        result_.counts = top.counts;
        result_.box = {
            own_point(made_.front(), top.box.lower), own_point(made_.front(), top.box.upper)};
        std::vector<PlacedGrid> grids = {PlacedGrid{}};
        for (std::size_t level = 1; level <= deepest && !grids.empty() && !too_many(); ++level) {
            result_.levels.emplace_back();
            std::vector<PlacedGrid> below;
            for (const PlacedGrid& placed : grids) {
                if (cancel != nullptr)
                    cancel->throw_if_raised();
                visit(placed, level == deepest, below);
                if (too_many() && level > 1)
                    break;
            }
            grids = std::move(below);
        }
        return result_;
    }

    bool too_many() const { return result_.cells.size() > most_cells_; }

private:
    const Geometry& geometry(std::size_t number) const {
        return number == 0 ? scene_.geometry : scene_.subscenes[number - 1];
    }

    void visit(const PlacedGrid& placed, bool is_deepest, std::vector<PlacedGrid>& below) {
        const GeometryGrids& grids = made_[placed.geometry];
        const Grid& grid = grids.grids[placed.grid];
        GridLevel& level = result_.levels.back();
        ++level.grids;
        for (std::int32_t z = 0; z < grid.counts[2]; ++z)
            for (std::int32_t y = 0; y < grid.counts[1]; ++y)
                for (std::int32_t x = 0; x < grid.counts[0]; ++x) {
                    const std::size_t number =
                        grid.first_cell
                        + static_cast<std::size_t>(
                            x + grid.counts[0] * (y + std::int64_t{grid.counts[1]} * z));
                    ++level.cells;
                    visit_cell(placed, {x, y, z}, grids.cells[number], is_deepest, below);
                }
        // A subscene stands in many cells, but is called once.
        if (placed.grid != 0)
            return;
        for (const SubsceneCall& call : geometry(placed.geometry).calls) {
            const auto callee = static_cast<std::size_t>(call.subscene) + 1;
            if (made_[callee].grids.empty())
                continue;
            result_.whole = result_.whole && !is_deepest;
            if (!is_deepest)
                below.push_back({callee, 0, composed(placed.to_scene, call.to_parent)});
        }
    }

    void visit_cell(
        const PlacedGrid& placed,
        const std::array<std::int32_t, 3>& place,
        Cell cell,
        bool is_deepest,
        std::vector<PlacedGrid>& below) {
        if (cell.empty())
            return;
        const GeometryGrids& grids = made_[placed.geometry];
        GridLevel& level = result_.levels.back();
        ++level.full_cells;
        if (cell.is_grid()) {
            result_.whole = result_.whole && !is_deepest;
            if (is_deepest)
                add(placed, place, 0);
            else
                below.push_back({placed.geometry, cell.grid(), placed.to_scene});
            return;
        }
        const std::uint32_t length = grids.lists[cell.list()];
        level.references += length;
        level.longest_list = std::max<std::size_t>(level.longest_list, length);
        if (is_deepest || holds_primitive(placed.geometry, cell))
            add(placed, place, length);
    }

    bool holds_primitive(std::size_t number, Cell cell) const {
        const Geometry& in = geometry(number);
        const std::vector<std::uint32_t>& lists = made_[number].lists;
        const auto first = lists.begin() + static_cast<std::ptrdiff_t>(cell.list()) + 1;
        return std::any_of(first, first + lists[cell.list()], [&](std::uint32_t element) {
            return in.items[element_at(in, element).item].kind != ItemKind::subscene_call;
        });
    }

    void
    add(const PlacedGrid& placed, const std::array<std::int32_t, 3>& place, std::uint32_t objects) {
        const GeometryGrids& grids = made_[placed.geometry];
        const Grid& grid = grids.grids[placed.grid];
        Vec3 lower = grid.box.lower;
        for (std::size_t axis = 0; axis < 3; ++axis)
            lower[axis] += grid.cell_size[axis] * place[axis];
        const Vec3 size = (1 / grids.scale) * grid.cell_size;
        const Affine3 cube = {
            {{Vec3{size.x, 0, 0}, Vec3{0, size.y, 0}, Vec3{0, 0, size.z}}},
            own_point(grids, lower)};
        result_.cells.push_back(
            {composed(placed.to_scene, cube),
             static_cast<std::uint32_t>(result_.levels.size()),
             objects});
    }

    const Scene& scene_;
    const std::vector<GeometryGrids>& made_;
    std::size_t most_cells_;
    GridCells result_;
};

} // namespace

GridCells grid_cells(
    const Scene& scene,
    const GridSettings& settings,
    std::size_t levels,
    std::size_t most_cells,
    const Progress& progress,
    const CancelFlag* cancel) {
    detail::refuse_index_that_does_not_fit("the tree of grids", grid_forecast(scene, settings));
    const std::vector<Box3> boxes = subscene_bounds(scene);
    const auto made =
        detail::made_of_geometries<GeometryGrids>(scene, progress, [&](const Geometry& geometry) {
            return detail::build_geometry_grids(geometry, boxes, settings, cancel);
        });
    Walk walk(scene, made, most_cells);
    GridCells result = walk.down_to(1, cancel);
    for (std::size_t deepest = 2; deepest <= levels && !result.whole; ++deepest) {
        GridCells deeper = walk.down_to(deepest, cancel);
        if (walk.too_many())
            break;
        result = std::move(deeper);
    }
    return result;
}

} // namespace vera
