// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/traced_rings.h"

#include "vera/base/free_room.h"
#include "vera/base/long_loop.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

namespace vera {

namespace {

bool is_straight_on(ScreenStep a, ScreenStep b) {
    return cross(a, b) == 0;
}

/// Ways with which rings may begin, in parts that have no region in common; those of one part in
/// ascending order.
struct PartedWays {
    std::vector<std::uint32_t> ways;
    std::vector<std::size_t> starts; ///< of the parts, and the end

    std::span<const std::uint32_t> of(std::size_t part) const {
        return std::span(ways).subspan(starts[part], starts[part + 1] - starts[part]);
    }
};

/// Of each region the part of all ways, so many of which are one, in which its first one is.
std::vector<std::uint32_t>
parts_of_regions(const Ways& ways, std::size_t regions, std::size_t ways_of_a_part) {
    constexpr std::uint32_t no_part = ~std::uint32_t{0};
    std::vector<std::uint32_t> parts(regions, no_part);
    for (std::size_t way = 0; way < ways.count(); ++way)
        if (const std::uint32_t region = ways.region[way];
            region != no_region && parts[region] == no_part)
            parts[region] = static_cast<std::uint32_t>(way / ways_of_a_part);
    return parts;
}

/// By where each region begins, as ways of one are near each other in memory. Threads share the
/// blocks of ways. A ring begins with the first of its ways, which no way before it follows.
PartedWays parted_by_region(
    const Ways& ways,
    std::size_t regions,
    std::span<const std::uint32_t> next,
    const CancelFlag* cancel) {
    constexpr std::size_t most_parts = 1024;
    constexpr std::size_t least_of_a_part = 4096;
    constexpr std::size_t ways_of_a_block = 32768;
    const std::size_t ways_of_a_part = std::max(least_of_a_part, ways.count() / most_parts + 1);
    const std::size_t parts = ways.count() / ways_of_a_part + 1;
    const std::size_t blocks = (ways.count() + ways_of_a_block - 1) / ways_of_a_block;
    const std::vector<std::uint32_t> part_of = parts_of_regions(ways, regions, ways_of_a_part);
    const auto for_each_of_block = [&](std::size_t number, const auto& visit) {
        stop_if_raised(cancel);
        const std::size_t end = std::min(ways.count(), (number + 1) * ways_of_a_block);
        for (std::size_t way = number * ways_of_a_block; way < end; ++way)
            if (ways.region[way] != no_region && next[way] >= way)
                visit(way, part_of[ways.region[way]]);
    };
    // By part and block within it, so that the ways of a part stay in their order.
    std::vector<std::size_t> starts(parts * blocks + 1);
    parallel_ranges(blocks, 1, [&](std::size_t number, std::size_t) {
        for_each_of_block(
            number, [&](std::size_t, std::size_t part) { ++starts[part * blocks + number + 1]; });
    });
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    PartedWays parted;
    for (std::size_t part = 0; part <= parts; ++part)
        parted.starts.push_back(starts[part * blocks]);
    parted.ways.resize(starts.back());
    parallel_ranges(blocks, 1, [&](std::size_t number, std::size_t) {
        for_each_of_block(number, [&](std::size_t way, std::size_t part) {
            parted.ways[starts[part * blocks + number]++] = static_cast<std::uint32_t>(way);
        });
    });
    return parted;
}

/// Of each way, whether the one that follows goes another way, or has something else across.
std::vector<bool> ways_before_corners(const Ways& ways, std::span<const std::uint32_t> next) {
    std::vector<bool> result(next.size());
    constexpr std::size_t block = 4096; // whole words, so that no two threads write one
    parallel_ranges((next.size() + block - 1) / block, 1, [&](std::size_t number, std::size_t) {
        for (std::size_t i = number * block; i < std::min(next.size(), (number + 1) * block); ++i) {
            const auto way = static_cast<std::uint32_t>(i);
            const bool goes_on = is_straight_on(ways.direction(way), ways.direction(next[i]))
                && ways.region[way ^ 1U] == ways.region[next[i] ^ 1U];
            result[i] = !goes_on;
        }
    });
    return result;
}

/// The ring along the way. next[i] is the way that follows way i, and none from now on of those
/// along the ring.
void trace_ring(
    std::uint32_t first,
    const Ways& ways,
    const std::vector<bool>& is_before_corner,
    RingDetail detail,
    std::span<std::uint32_t> next,
    TracedRings& traced) {
    const auto add = [&](std::uint32_t vertex, std::uint32_t across) {
        traced.ring_vertices.push_back(vertex);
        if (detail == RingDetail::with_across)
            traced.ring_across.push_back(across);
    };
    std::uint32_t way = first;
    do {
        const std::uint32_t after = std::exchange(next[way], no_way);
        const bool is_joined = ways.to(way) != ways.from(after);
        if (is_joined) {
            traced.joined_sides.push_back(traced.ring_vertices.size());
            add(ways.to(way), no_region);
        }
        if (is_joined || is_before_corner[way])
            add(ways.from(after), ways.region[after ^ 1U]);
        way = after;
    } while (way != first);
}

} // namespace

std::vector<TracedRings> traced_rings(
    Ways ways,
    std::size_t regions,
    RingDetail detail,
    std::vector<std::uint32_t> next,
    const Progress& progress,
    const CancelFlag* cancel) {
    const std::vector<bool> is_before_corner = ways_before_corners(ways, next);
    free_room(ways.steps); // before there are the rings
    const PartedWays parted = parted_by_region(ways, regions, next, cancel);
    std::vector<TracedRings> parts(parted.starts.size() - 1);
    long_parallel_loop(parts.size(), progress, cancel, 1, [&](std::size_t part) {
        TracedRings traced;
        const std::span<const std::uint32_t> own = parted.of(part);
        const LongLoop loop(own.size(), {}, cancel);
        for (std::size_t i = 0; i < own.size(); ++i) {
            loop.turn(i);
            if (next[own[i]] == no_way)
                continue;
            traced.rings.push_back(
                {ways.region[own[i]], static_cast<std::uint32_t>(traced.ring_vertices.size())});
            trace_ring(own[i], ways, is_before_corner, detail, next, traced);
        }
        traced.rings.shrink_to_fit();
        traced.ring_vertices.shrink_to_fit();
        traced.ring_across.shrink_to_fit();
        parts[part] = std::move(traced);
    });
    return parts;
}

namespace {

/// Puts the rings of the parts into the map, by region, and notes their places. No two parts have
/// rings of one region.
void place_rings(std::vector<TracedRings>& parts, VisibleMap& map) {
    std::vector<std::uint32_t> next(map.regions.size() + 1); // place of a ring of each region
    for (const TracedRings& part : parts)
        for (const TracedRings::Ring& ring : part.rings)
            ++next[ring.region + std::size_t{1}];
    std::partial_sum(next.begin(), next.end(), next.begin());
    map.rings.resize(next.back());
    parallel_ranges(parts.size(), 1, [&](std::size_t number, std::size_t) {
        TracedRings& part = parts[number];
        part.places.reserve(part.rings.size());
        for (std::size_t i = 0; i < part.rings.size(); ++i) {
            const std::uint32_t region = part.rings[i].region;
            part.places.push_back(next[region]++);
            map.rings[part.places.back()] = {
                map.regions[region].source, region, 0, part.count_of(i)};
        }
    });
    std::size_t first = 0;
    for (VisibleMap::Ring& ring : map.rings) {
        ring.first = first;
        first += ring.count;
    }
}

} // namespace

void join_rings(std::vector<TracedRings> parts, RingDetail detail, VisibleMap& map) {
    std::size_t vertices = 0;
    for (const TracedRings& part : parts)
        vertices += part.ring_vertices.size();
    place_rings(parts, map);
    map.ring_vertices.resize(vertices);
    if (detail == RingDetail::with_across)
        map.ring_across.resize(vertices);
    parallel_ranges(parts.size(), 1, [&](std::size_t number, std::size_t) {
        TracedRings& part = parts[number];
        for (std::size_t i = 0; i < part.rings.size(); ++i) {
            const std::size_t from = part.rings[i].first;
            const auto& [source, region, to, count] = map.rings[part.places[i]];
            std::copy_n(part.ring_vertices.data() + from, count, map.ring_vertices.data() + to);
            if (detail == RingDetail::with_across)
                std::copy_n(part.ring_across.data() + from, count, map.ring_across.data() + to);
        }
        free_room(part.ring_vertices);
        free_room(part.ring_across);
    });
    for (const TracedRings& part : parts)
        for (const std::size_t side : part.joined_sides) {
            const auto behind = std::ranges::upper_bound(
                part.rings, side, {}, &TracedRings::Ring::first); // the ring after the side's
            const auto ring = static_cast<std::size_t>(behind - part.rings.begin()) - 1;
            map.joined_sides.push_back(
                map.rings[part.places[ring]].first + side - part.rings[ring].first);
        }
    std::ranges::sort(map.joined_sides);
}

} // namespace vera
