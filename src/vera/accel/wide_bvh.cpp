// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/wide_bvh.h"

#include "vera/accel/index_memory.h"
#include "vera/accel/packet_index.h"
#include "vera/accel/simd_level.h"
#include "vera/accel/tree_build.h"
#include "vera/accel/walk_recorder.h"
#include "vera/scene/bounds.h"

#include <algorithm>

namespace vera {

namespace {

using detail::GeometryTree;

class ForestOfBoxes : public detail::PacketIndex<WideBvh, GeometryTree> {
public:
    using PacketIndex::PacketIndex;

    WideBvhStatistics statistics() const override {
        WideBvhStatistics result;
        result.geometries = made().size();
        for (const GeometryTree& tree : made()) {
            result.levels = std::max(result.levels, tree.levels);
            result.nodes += tree.nodes.size();
            result.blocks += tree.blocks;
            result.elements += tree.elements;
            result.bytes += sizeof(GeometryTree) + tree.nodes.size() * sizeof(detail::WideNode)
                + tree.rows.size() * sizeof(detail::BlockRow) + vera::memory(tree.outlines);
        }
        return result;
    }
};

} // namespace

IndexForecast wide_bvh_forecast(const Scene& scene) {
    IndexForecast forecast;
    forecast.bytes = detail::forecast_tree_bytes(scene.geometry);
    for (const Geometry& subscene : scene.subscenes)
        forecast.bytes += detail::forecast_tree_bytes(subscene);
    forecast.available_bytes = detail::memory_to_give();
    return forecast;
}

std::unique_ptr<WideBvh>
make_wide_bvh(const Scene& scene, const Progress& progress, const CancelFlag* cancel) {
    honour_simd_environment();
    detail::refuse_index_that_does_not_fit("the hierarchy of boxes", wide_bvh_forecast(scene));
    const std::vector<Box3> boxes = subscene_bounds(scene);
    auto trees =
        detail::made_of_geometries<GeometryTree>(scene, progress, [&](const Geometry& geometry) {
            return detail::build_geometry_tree(geometry, boxes, cancel);
        });
    return std::make_unique<ForestOfBoxes>(
        scene, std::move(trees), detail::search_trees, detail::walk_trees);
}

} // namespace vera
