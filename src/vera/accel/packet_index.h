// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/local_geometry.h"
#include "vera/accel/packet_query.h"
#include "vera/accel/ray_index.h"
#include "vera/accel/ray_walk.h"
#include "vera/accel/searches.h"
#include "vera/base/parallel.h"

#include <span>
#include <utility>
#include <vector>

namespace vera::detail {

/// What an index that answers packet by packet has made of a scene, and its way of searching it.
struct SearchedScene {
    const Scene* scene = nullptr;
    std::vector<const LocalGeometry*> geometries; ///< of the main scene, then of the subscenes
    bool opaque = false;                          ///< no material lets light through
    /// Leaves candidates of the main scene to be decided: see decide_main_scene().
    void (*search)(PacketQuery& query) = nullptr;
    WalkRecorder* recorder = nullptr; ///< of a search that is a plain walk
};

/// RayIndex::nearest_hits.
void find_nearest_hits(
    const SearchedScene& searched,
    std::span<const QueryRay> rays,
    std::span<Hit> hits,
    QueryCounts& counts);

/// RayIndex::transmittances.
void find_transmittances(
    const SearchedScene& searched,
    std::span<const QueryRay> rays,
    std::span<Color> transmitted,
    QueryCounts& counts);

/// WalkedIndex::nearest_walk and transmittance_walk, by a plain walk in place of the search.
RayWalk
walk_nearest(const SearchedScene& searched, void (*walk)(PacketQuery& query), const QueryRay& ray);
RayWalk walk_transmittance(
    const SearchedScene& searched, void (*walk)(PacketQuery& query), const QueryRay& ray);

/// A kind of RayIndex that answers packet by packet from what it has made of each geometry, which
/// is a LocalGeometry and more. Walks are those of one ray.
template <typename Index, typename Made>
class PacketIndex : public Index, public WalkedIndex {
public:
    PacketIndex(
        const Scene& scene,
        std::vector<Made> made,
        void (*search)(PacketQuery& query),
        void (*walk)(PacketQuery& query))
        : made_(std::move(made))
        , walk_(walk) {
        searched_.scene = &scene;
        searched_.opaque = is_opaque(scene);
        searched_.search = search;
        for (const Made& of_geometry : made_)
            searched_.geometries.push_back(&of_geometry);
    }

    void nearest_hits(
        std::span<const QueryRay> rays, std::span<Hit> hits, QueryCounts& counts) const override {
        find_nearest_hits(searched_, rays, hits, counts);
    }

    void transmittances(
        std::span<const QueryRay> rays,
        std::span<Color> transmitted,
        QueryCounts& counts) const override {
        find_transmittances(searched_, rays, transmitted, counts);
    }

    RayWalk nearest_walk(const QueryRay& ray) const override {
        return walk_nearest(searched_, walk_, ray);
    }

    RayWalk transmittance_walk(const QueryRay& ray) const override {
        return walk_transmittance(searched_, walk_, ray);
    }

    std::size_t memory() const override { return this->statistics().bytes; }

protected:
    const std::vector<Made>& made() const { return made_; }

private:
    std::vector<Made> made_;
    void (*walk_)(PacketQuery& query);
    SearchedScene searched_;
};

/// What build(geometry) makes of the main scene, then of the subscenes.
template <typename Made, typename Build>
std::vector<Made>
made_of_geometries(const Scene& scene, const Progress& progress, const Build& build) {
    std::vector<Made> made;
    made.reserve(scene.subscenes.size() + 1);
    auto elements = static_cast<double>(scene.geometry.element_count);
    for (const Geometry& subscene : scene.subscenes)
        elements += static_cast<double>(subscene.element_count);
    double done = 0;
    const auto add = [&](const Geometry& geometry) {
        made.push_back(build(geometry));
        done += static_cast<double>(geometry.element_count);
        if (progress)
            progress(elements > 0 ? done / elements : 1);
    };
    add(scene.geometry);
    for (const Geometry& subscene : scene.subscenes)
        add(subscene);
    return made;
}

} // namespace vera::detail
