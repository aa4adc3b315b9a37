// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/packet_index.h"

#include "vera/accel/walk_recorder.h"
#include "vera/base/check.h"

#include <algorithm>
#include <array>
#include <limits>

namespace vera::detail {

namespace {

/// Each thread keeps the memory of its queries: of the packet that is searched, and of the one
/// before, which is decided when what that takes has arrived.
std::array<PacketQuery, 2>& queries_of_this_thread() {
    thread_local std::array<PacketQuery, 2> queries;
    return queries;
}

void start(
    PacketQuery& query,
    const SearchedScene& searched,
    std::span<const QueryRay> rays,
    Purpose purpose) {
    query.scene = searched.scene;
    query.geometries = searched.geometries;
    query.recorder = searched.recorder;
    query.purpose = purpose;
    query.active = ~LaneMask{0} >> (std::numeric_limits<LaneMask>::digits - rays.size());
    take_rays(query, rays);
}

/// For rays that meet many coincident faces: the first search has told where they lie.
void look_again(
    PacketQuery& query, const SearchedScene& searched, LaneMask undecided, std::span<Hit> hits) {
    start(query, searched, query.rays, Purpose::window);
    query.reach.fill(0);
    query.active = undecided;
    query.window.clear();
    for (std::size_t lane = 0; lane < query.rays.size(); ++lane) {
        query.window.emplace_back(query.nearest[lane].window_end());
        query.limit[lane] = std::min(query.limit[lane], query.window[lane].limit());
    }
    searched.search(query);
    decide_main_scene(query);
    for (std::size_t lane = 0; lane < query.rays.size(); ++lane)
        if ((undecided >> lane & 1U) != 0)
            hits[lane] = query.window[lane].hit();
}

void take_hits(PacketQuery& query, const SearchedScene& searched, std::span<Hit> hits) {
    decide_main_scene(query);
    LaneMask undecided = 0;
    for (std::size_t lane = 0; lane < query.rays.size(); ++lane)
        if (query.nearest[lane].undecided())
            undecided |= LaneMask{1} << lane;
        else
            hits[lane] = query.nearest[lane].hit();
    if (undecided != 0)
        look_again(query, searched, undecided, hits);
}

void take_transmitted(PacketQuery& query, std::span<Color> transmitted) {
    decide_main_scene(query);
    if (query.purpose == Purpose::any) {
        for (std::size_t lane = 0; lane < query.rays.size(); ++lane) {
            const double part = (query.active >> lane & 1U) != 0 ? 1 : 0;
            transmitted[lane] = {part, part, part};
        }
        return;
    }
    for (std::size_t lane = 0; lane < query.rays.size(); ++lane)
        transmitted[lane] = query.transmittance[lane].transmitted();
}

/// Searches packet by packet, and finishes each while the next one's memory is on its way:
/// begin(query, rays), finish(query, first).
template <typename Begin, typename Finish>
void for_each_packet(
    const SearchedScene& searched,
    std::span<const QueryRay> rays,
    QueryCounts& counts,
    const Begin& begin,
    const Finish& finish) {
    std::array<PacketQuery, 2>& queries = queries_of_this_thread();
    std::size_t which = 0;
    for (std::size_t first = 0; first < rays.size(); first += packet_size) {
        PacketQuery& query = queries[which];
        begin(query, rays.subspan(first, std::min(packet_size, rays.size() - first)));
        searched.search(query);
        which = 1 - which;
        if (first > 0)
            finish(queries[which], first - packet_size);
    }
    if (!rays.empty())
        finish(queries[1 - which], (rays.size() - 1) / packet_size * packet_size);
    counts.rays += rays.size();
    for (PacketQuery& query : queries) {
        counts += query.counts;
        query.counts = {};
    }
}

} // namespace

void find_nearest_hits(
    const SearchedScene& searched,
    std::span<const QueryRay> rays,
    std::span<Hit> hits,
    QueryCounts& counts) {
    VERA_CHECK(rays.size() == hits.size());
    const auto begin = [&](PacketQuery& query, std::span<const QueryRay> packet) {
        start(query, searched, packet, Purpose::nearest);
        find_reaches(query);
        for (std::size_t lane = 0; lane < packet.size(); ++lane)
            query.nearest[lane].start(query.reach[lane]);
    };
    const auto finish = [&](PacketQuery& query, std::size_t first) {
        take_hits(query, searched, hits.subspan(first, query.rays.size()));
    };
    for_each_packet(searched, rays, counts, begin, finish);
}

void find_transmittances(
    const SearchedScene& searched,
    std::span<const QueryRay> rays,
    std::span<Color> transmitted,
    QueryCounts& counts) {
    VERA_CHECK(rays.size() == transmitted.size());
    const Purpose purpose = searched.opaque ? Purpose::any : Purpose::transmittance;
    const auto begin = [&](PacketQuery& query, std::span<const QueryRay> packet) {
        start(query, searched, packet, purpose);
        query.reach.fill(0);
        if (purpose == Purpose::transmittance)
            for (std::size_t lane = 0; lane < packet.size(); ++lane)
                query.transmittance[lane].clear();
    };
    const auto finish = [&](PacketQuery& query, std::size_t first) {
        take_transmitted(query, transmitted.subspan(first, query.rays.size()));
    };
    for_each_packet(searched, rays, counts, begin, finish);
}

namespace {

/// The same scene, searched by a walk that tells its steps.
SearchedScene
walked(SearchedScene searched, void (*walk)(PacketQuery& query), WalkRecorder& recorder) {
    searched.search = walk;
    searched.recorder = &recorder;
    return searched;
}

} // namespace

RayWalk
walk_nearest(const SearchedScene& searched, void (*walk)(PacketQuery& query), const QueryRay& ray) {
    RayWalk result;
    WalkRecorder recorder(result);
    find_nearest_hits(walked(searched, walk, recorder), {&ray, 1}, {&result.hit, 1}, result.counts);
    return result;
}

RayWalk walk_transmittance(
    const SearchedScene& searched, void (*walk)(PacketQuery& query), const QueryRay& ray) {
    RayWalk result;
    WalkRecorder recorder(result);
    find_transmittances(
        walked(searched, walk, recorder), {&ray, 1}, {&result.transmitted, 1}, result.counts);
    return result;
}

} // namespace vera::detail
