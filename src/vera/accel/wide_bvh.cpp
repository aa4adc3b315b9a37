// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/wide_bvh.h"

#include "vera/accel/index_memory.h"
#include "vera/accel/packet_index.h"
#include "vera/accel/simd_level.h"
#include "vera/accel/tree_build.h"
#include "vera/scene/bounds.h"

#include <algorithm>

namespace vera {

namespace {

using detail::GeometryTree;

class ForestOfBoxes : public WideBvh {
public:
    ForestOfBoxes(const Scene& scene, std::vector<GeometryTree> trees)
        : trees_(std::move(trees)) {
        searched_.scene = &scene;
        searched_.opaque = detail::is_opaque(scene);
        searched_.search = detail::search_trees;
        for (const GeometryTree& tree : trees_)
            searched_.geometries.push_back(&tree);
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

    WideBvhStatistics statistics() const override {
        WideBvhStatistics result;
        result.geometries = trees_.size();
        for (const GeometryTree& tree : trees_) {
            result.levels = std::max(result.levels, tree.levels);
            result.nodes += tree.nodes.size();
            result.blocks += tree.blocks;
            result.elements += tree.elements;
            result.bytes += sizeof(GeometryTree) + tree.nodes.size() * sizeof(detail::WideNode)
                + tree.rows.size() * sizeof(detail::BlockRow) + vera::memory(tree.outlines);
        }
        return result;
    }

private:
    std::vector<GeometryTree> trees_;
    detail::SearchedScene searched_;
};

std::size_t element_count(const Scene& scene) {
    std::size_t count = scene.geometry.element_count;
    for (const Geometry& subscene : scene.subscenes)
        count += subscene.element_count;
    return count;
}

} // namespace

std::unique_ptr<WideBvh>
make_wide_bvh(const Scene& scene, const Progress& progress, const CancelFlag* cancel) {
    honour_simd_environment();
    const std::size_t elements = element_count(scene);
    detail::refuse_index_that_does_not_fit(
        "the hierarchy of boxes", detail::forecast_tree_bytes(elements), detail::memory_to_give());
    const std::vector<Box3> boxes = subscene_bounds(scene);
    std::vector<GeometryTree> trees;
    trees.reserve(scene.subscenes.size() + 1);
    std::size_t done = 0;
    const auto build = [&](const Geometry& geometry) {
        trees.push_back(detail::build_geometry_tree(geometry, boxes, cancel));
        done += geometry.element_count;
        if (progress)
            progress(elements > 0 ? static_cast<double>(done) / static_cast<double>(elements) : 1);
    };
    build(scene.geometry);
    for (const Geometry& subscene : scene.subscenes)
        build(subscene);
    return std::make_unique<ForestOfBoxes>(scene, std::move(trees));
}

} // namespace vera
