// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/grid_tree.h"

#include "vera/accel/grid_build.h"
#include "vera/accel/index_memory.h"
#include "vera/accel/packet_index.h"
#include "vera/accel/simd_level.h"
#include "vera/scene/bounds.h"

#include <algorithm>

namespace vera {

namespace {

using detail::GeometryGrids;

class TreeOfGrids : public GridTree {
public:
    TreeOfGrids(const Scene& scene, std::vector<GeometryGrids> geometries)
        : geometries_(std::move(geometries)) {
        searched_.scene = &scene;
        searched_.opaque = detail::is_opaque(scene);
        searched_.search = detail::search_grids;
        for (const GeometryGrids& grids : geometries_)
            searched_.geometries.push_back(&grids);
    }

    void nearest_hits(
        std::span<const QueryRay> rays, std::span<Hit> hits, QueryCounts& counts) const override {
        detail::find_nearest_hits(searched_, rays, hits, counts);
    }

    void transmittances(
        std::span<const QueryRay> rays,
        std::span<Color> transmitted,
        QueryCounts& counts) const override {
        detail::find_transmittances(searched_, rays, transmitted, counts);
    }

    std::size_t memory() const override { return statistics().bytes; }

    GridTreeStatistics statistics() const override;

private:
    std::vector<GeometryGrids> geometries_;
    detail::SearchedScene searched_;
};

GridTreeStatistics TreeOfGrids::statistics() const {
    GridTreeStatistics result;
    result.geometries = geometries_.size();
    for (const GeometryGrids& grids : geometries_) {
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
    const GridForecast forecast = grid_forecast(scene, settings);
    detail::refuse_index_that_does_not_fit(
        "the tree of grids", forecast.bytes, forecast.available_bytes);
    const std::vector<Box3> boxes = subscene_bounds(scene);
    std::vector<GeometryGrids> geometries;
    geometries.reserve(scene.subscenes.size() + 1);
    double elements = static_cast<double>(scene.geometry.element_count);
    for (const Geometry& subscene : scene.subscenes)
        elements += static_cast<double>(subscene.element_count);
    double done = 0;
    const auto build = [&](const Geometry& geometry) {
        geometries.push_back(detail::build_geometry_grids(geometry, boxes, settings, cancel));
        done += static_cast<double>(geometry.element_count);
        if (progress)
            progress(elements > 0 ? done / elements : 1);
    };
    build(scene.geometry);
    for (const Geometry& subscene : scene.subscenes)
        build(subscene);
    return std::make_unique<TreeOfGrids>(scene, std::move(geometries));
}

} // namespace vera
