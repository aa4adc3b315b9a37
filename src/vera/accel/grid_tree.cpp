// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/grid_tree.h"

#include "vera/accel/grid_build.h"
#include "vera/accel/index_memory.h"
#include "vera/accel/packet_index.h"
#include "vera/accel/simd_level.h"
#include "vera/accel/walk_recorder.h"
#include "vera/scene/bounds.h"

#include <algorithm>

namespace vera {

namespace {

using detail::GeometryGrids;

class TreeOfGrids : public detail::PacketIndex<GridTree, GeometryGrids> {
public:
    using PacketIndex::PacketIndex;

    GridTreeStatistics statistics() const override;
};

GridTreeStatistics TreeOfGrids::statistics() const {
    GridTreeStatistics result;
    result.geometries = made().size();
    for (const GeometryGrids& grids : made()) {
        result.levels = std::max(result.levels, grids.levels);
        result.grids += grids.grids.size();
        result.cells += grids.cells.size();
        result.elements += grids.records.size();
        for (const detail::Cell& cell : grids.cells)
            if (cell.empty()) {
                ++result.empty_cells;
            } else if (!cell.is_grid()) {
                const std::size_t length = grids.lists[cell.list()];
                result.references += length;
                result.longest_list = std::max(result.longest_list, length);
            }
        result.bytes += sizeof(GeometryGrids) + grids.grids.size() * sizeof(detail::Grid)
            + grids.cells.size() * sizeof(detail::Cell) + grids.lists.size() * sizeof(std::uint32_t)
            + grids.records.size() * sizeof(detail::ElementRecord) + vera::memory(grids.outlines);
    }
    return result;
}

} // namespace

std::unique_ptr<GridTree> make_grid_tree(
    const Scene& scene,
    const GridSettings& settings,
    const Progress& progress,
    const CancelFlag* cancel) {
    honour_simd_environment();
    detail::refuse_index_that_does_not_fit("the tree of grids", grid_forecast(scene, settings));
    const std::vector<Box3> boxes = subscene_bounds(scene);
    auto grids =
        detail::made_of_geometries<GeometryGrids>(scene, progress, [&](const Geometry& geometry) {
            return detail::build_geometry_grids(geometry, boxes, settings, cancel);
        });
    return std::make_unique<TreeOfGrids>(
        scene, std::move(grids), detail::search_grids, detail::walk_grids);
}

} // namespace vera
