// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/grid_tree.h"

#include "vera/accel/grid_build.h"
#include "vera/accel/packet_query.h"
#include "vera/accel/simd_level.h"
#include "vera/base/check.h"
#include "vera/scene/bounds.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace vera {

namespace {

using detail::GeometryGrids;
using detail::LaneMask;
using detail::packet_size;
using detail::PacketQuery;
using detail::Purpose;

/// Each thread keeps the memory of its queries.
PacketQuery& query_of_this_thread() {
    thread_local PacketQuery query;
    return query;
}

class TreeOfGrids : public GridTree {
public:
    TreeOfGrids(const Scene& scene, std::vector<GeometryGrids> geometries)
        : scene_(&scene)
        , geometries_(std::move(geometries))
        , opaque_(detail::is_opaque(scene)) {}

    void nearest_hits(
        std::span<const QueryRay> rays, std::span<Hit> hits, QueryCounts& counts) const override {
        VERA_CHECK(rays.size() == hits.size());
        PacketQuery& query = query_of_this_thread();
        for (std::size_t first = 0; first < rays.size(); first += packet_size) {
            const std::size_t size = std::min(packet_size, rays.size() - first);
            nearest(query, rays.subspan(first, size), hits.subspan(first, size));
        }
        count(query, rays.size(), counts);
    }

    void transmittances(
        std::span<const QueryRay> rays,
        std::span<Color> transmitted,
        QueryCounts& counts) const override {
        VERA_CHECK(rays.size() == transmitted.size());
        PacketQuery& query = query_of_this_thread();
        for (std::size_t first = 0; first < rays.size(); first += packet_size) {
            const std::size_t size = std::min(packet_size, rays.size() - first);
            start(
                query, rays.subspan(first, size), opaque_ ? Purpose::any : Purpose::transmittance);
            for (std::size_t lane = 0; lane < size; ++lane)
                query.transmittance[lane].clear();
            detail::search_grids(query);
            for (std::size_t lane = 0; lane < size; ++lane)
                transmitted[first + lane] = query.transmittance[lane].transmitted();
        }
        count(query, rays.size(), counts);
    }

    std::size_t memory() const override { return statistics().bytes; }

    GridTreeStatistics statistics() const override;

private:
    void start(PacketQuery& query, std::span<const QueryRay> rays, Purpose purpose) const {
        query.scene = scene_;
        query.geometries = &geometries_;
        query.purpose = purpose;
        query.rays = rays;
        query.active = (LaneMask{1} << rays.size()) - 1;
        for (std::size_t lane = 0; lane < rays.size(); ++lane)
            query.limit[lane] = rays[lane].ray.t_max;
    }

    void nearest(PacketQuery& query, std::span<const QueryRay> rays, std::span<Hit> hits) const {
        start(query, rays, Purpose::nearest);
        query.nearest.clear();
        for (const QueryRay& ray : rays)
            query.nearest.emplace_back(ray.ray);
        detail::search_grids(query);
        LaneMask undecided = 0;
        for (std::size_t lane = 0; lane < rays.size(); ++lane)
            if (query.nearest[lane].undecided())
                undecided |= LaneMask{1} << lane;
            else
                hits[lane] = query.nearest[lane].hit();
        if (undecided != 0)
            look_again(query, undecided, hits);
    }

    /// For rays that meet many coincident faces: the first search has told where they lie.
    void look_again(PacketQuery& query, LaneMask undecided, std::span<Hit> hits) const {
        start(query, query.rays, Purpose::window);
        query.active = undecided;
        query.window.clear();
        for (std::size_t lane = 0; lane < query.rays.size(); ++lane) {
            query.window.emplace_back(query.nearest[lane].window_end());
            query.limit[lane] = std::min(query.limit[lane], query.window[lane].limit());
        }
        detail::search_grids(query);
        for (std::size_t lane = 0; lane < query.rays.size(); ++lane)
            if ((undecided >> lane & 1U) != 0)
                hits[lane] = query.window[lane].hit();
    }

    static void count(PacketQuery& query, std::size_t rays, QueryCounts& counts) {
        counts += query.counts;
        counts.rays += rays;
        query.counts = {};
    }

    const Scene* scene_;
    std::vector<GeometryGrids> geometries_;
    bool opaque_;
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
            + grids.records.size() * sizeof(detail::ElementRecord);
    }
    return result;
}

void refuse_if_too_large(const GridForecast& forecast) {
    if (forecast.bytes <= forecast.available_bytes)
        return;
    const auto mebibytes = [](std::size_t bytes) { return std::to_string((bytes >> 20U) + 1); };
    throw std::runtime_error(
        "the tree of grids needs about " + mebibytes(forecast.bytes) + " MiB of memory, and "
        + mebibytes(forecast.available_bytes)
        + " MiB are available: call repeated parts of the scene as subscenes, or render it on a "
          "larger machine");
}

} // namespace

std::unique_ptr<GridTree> make_grid_tree(
    const Scene& scene,
    const GridSettings& settings,
    const Progress& progress,
    const CancelFlag* cancel) {
    honour_simd_environment();
    refuse_if_too_large(grid_forecast(scene, settings));
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
