// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/packet_index.h"

#include "vera/base/check.h"

#include <algorithm>

namespace vera::detail {

namespace {

/// Each thread keeps the memory of its queries.
PacketQuery& query_of_this_thread() {
    thread_local PacketQuery query;
    return query;
}

void start(
    PacketQuery& query,
    const SearchedScene& searched,
    std::span<const QueryRay> rays,
    Purpose purpose) {
    query.scene = searched.scene;
    query.geometries = searched.geometries;
    query.purpose = purpose;
    query.rays = rays;
    query.active = (LaneMask{1} << rays.size()) - 1;
    for (std::size_t lane = 0; lane < rays.size(); ++lane)
        query.limit[lane] = rays[lane].ray.t_max;
}

/// For rays that meet many coincident faces: the first search has told where they lie.
void look_again(
    PacketQuery& query, const SearchedScene& searched, LaneMask undecided, std::span<Hit> hits) {
    start(query, searched, query.rays, Purpose::window);
    query.active = undecided;
    query.window.clear();
    for (std::size_t lane = 0; lane < query.rays.size(); ++lane) {
        query.window.emplace_back(query.nearest[lane].window_end());
        query.limit[lane] = std::min(query.limit[lane], query.window[lane].limit());
    }
    searched.search(query);
    for (std::size_t lane = 0; lane < query.rays.size(); ++lane)
        if ((undecided >> lane & 1U) != 0)
            hits[lane] = query.window[lane].hit();
}

void find_nearest(
    PacketQuery& query,
    const SearchedScene& searched,
    std::span<const QueryRay> rays,
    std::span<Hit> hits) {
    start(query, searched, rays, Purpose::nearest);
    for (std::size_t lane = 0; lane < rays.size(); ++lane)
        query.nearest[lane].start(rays[lane].ray);
    searched.search(query);
    LaneMask undecided = 0;
    for (std::size_t lane = 0; lane < rays.size(); ++lane)
        if (query.nearest[lane].undecided())
            undecided |= LaneMask{1} << lane;
        else
            hits[lane] = query.nearest[lane].hit();
    if (undecided != 0)
        look_again(query, searched, undecided, hits);
}

void count(PacketQuery& query, std::size_t rays, QueryCounts& counts) {
    counts += query.counts;
    counts.rays += rays;
    query.counts = {};
}

} // namespace

void find_nearest_hits(
    const SearchedScene& searched,
    std::span<const QueryRay> rays,
    std::span<Hit> hits,
    QueryCounts& counts) {
    VERA_CHECK(rays.size() == hits.size());
    PacketQuery& query = query_of_this_thread();
    for (std::size_t first = 0; first < rays.size(); first += packet_size) {
        const std::size_t size = std::min(packet_size, rays.size() - first);
        find_nearest(query, searched, rays.subspan(first, size), hits.subspan(first, size));
    }
    count(query, rays.size(), counts);
}

void find_transmittances(
    const SearchedScene& searched,
    std::span<const QueryRay> rays,
    std::span<Color> transmitted,
    QueryCounts& counts) {
    VERA_CHECK(rays.size() == transmitted.size());
    PacketQuery& query = query_of_this_thread();
    const Purpose purpose = searched.opaque ? Purpose::any : Purpose::transmittance;
    for (std::size_t first = 0; first < rays.size(); first += packet_size) {
        const std::size_t size = std::min(packet_size, rays.size() - first);
        start(query, searched, rays.subspan(first, size), purpose);
        for (std::size_t lane = 0; lane < size; ++lane)
            query.transmittance[lane].clear();
        searched.search(query);
        for (std::size_t lane = 0; lane < size; ++lane)
            transmitted[first + lane] = query.transmittance[lane].transmitted();
    }
    count(query, rays.size(), counts);
}

} // namespace vera::detail
