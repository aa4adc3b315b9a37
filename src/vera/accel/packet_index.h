// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/local_geometry.h"
#include "vera/accel/packet_query.h"
#include "vera/accel/ray_index.h"

#include <span>
#include <vector>

namespace vera::detail {

/// What an index that answers packet by packet has made of a scene, and its way of searching it.
struct SearchedScene {
    const Scene* scene = nullptr;
    std::vector<const LocalGeometry*> geometries; ///< of the main scene, then of the subscenes
    bool opaque = false;                          ///< no material lets light through
    void (*search)(PacketQuery& query) = nullptr;
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

} // namespace vera::detail
