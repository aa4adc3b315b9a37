// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/visible_map.h"

#include "vera/base/free_room.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>

namespace vera {

namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

constexpr std::size_t block = 4096; ///< vertices or pieces that a thread takes at a time

/// The two ways along a piece: 2 i with, 2 i + 1 against its edge.
class Ways {
public:
    Ways(const ScreenScene& scene, const std::vector<VisiblePiece>& pieces)
        : region(2 * pieces.size(), no_region)
        , scene_(scene)
        , pieces_(pieces) {}

    std::size_t count() const { return region.size(); }

    /// Where the way begins.
    std::uint32_t from(std::uint32_t way) const {
        const VisiblePiece& piece = pieces_[way / 2];
        return way % 2 == 0 ? piece.from : piece.to;
    }

    std::uint32_t to(std::uint32_t way) const { return from(way ^ 1U); }

    /// Along the whole edge.
    ScreenStep direction(std::uint32_t way) const {
        const ScreenEdges::Edge& edge = pieces_[way / 2].edge;
        const ScreenPoint begin = scene_.vertices[edge.begin].point;
        const ScreenPoint end = scene_.vertices[edge.end].point;
        return way % 2 == 0 ? step(begin, end) : step(end, begin);
    }

    std::vector<std::uint32_t> region; ///< seen on the left

private:
    const ScreenScene& scene_;
    const std::vector<VisiblePiece>& pieces_;
};

/// Whether a lies in the half turn that begins with the direction to the right.
bool is_upper(ScreenStep a) {
    return a.y > 0 || (a.y == 0 && a.x > 0);
}

bool turns_before(ScreenStep a, ScreenStep b) {
    if (is_upper(a) != is_upper(b))
        return is_upper(a);
    return cross(a, b) > 0;
}

/// The ways that leave each vertex, in their order round it to the left.
struct Leaving {
    std::vector<std::uint32_t> starts;
    std::vector<std::uint32_t> ways;

    std::span<std::uint32_t> of(std::size_t vertex) {
        return std::span(ways).subspan(starts[vertex], starts[vertex + 1] - starts[vertex]);
    }
};

Leaving leaving_ways(const Ways& ways, std::size_t vertex_count, const CancelFlag* cancel) {
    Leaving leaving;
    leaving.starts.resize(vertex_count + 1);
    for (std::uint32_t way = 0; way < ways.count(); ++way)
        ++leaving.starts[ways.from(way) + 1];
    std::partial_sum(leaving.starts.begin(), leaving.starts.end(), leaving.starts.begin());
    leaving.ways.resize(ways.count());
    std::vector<std::uint32_t> next(leaving.starts.begin(), leaving.starts.end() - 1);
    for (std::uint32_t way = 0; way < ways.count(); ++way)
        leaving.ways[next[ways.from(way)]++] = way;
    parallel_ranges(vertex_count, block, [&](std::size_t first, std::size_t last) {
        stop_if_raised(cancel);
        for (std::size_t vertex = first; vertex < last; ++vertex) {
            const std::span<std::uint32_t> here = leaving.of(vertex);
            std::sort(here.begin(), here.end(), [&](std::uint32_t a, std::uint32_t b) {
                return turns_before(ways.direction(a), ways.direction(b));
            });
        }
    });
    return leaving;
}

/// Ways that end, or begin, where none of their region goes on.
struct Loose {
    std::vector<std::uint32_t> ends;
    std::vector<std::uint32_t> begins;

    void add(std::uint32_t end, std::uint32_t begin) {
        ends.push_back(end);
        begins.push_back(begin);
    }
};

Loose joined(std::span<const Loose> parts) {
    Loose all;
    for (const Loose& part : parts)
        for (std::size_t i = 0; i < part.ends.size(); ++i)
            all.add(part.ends[i], part.begins[i]);
    return all;
}

/// Joins each end to the nearest beginning of its region that is left. Those whose nearest is the
/// nearest come first: none takes the one that belongs to another.
void join(
    Loose loose,
    const Ways& ways,
    const CancelFlag* cancel,
    std::vector<std::uint32_t>& following,
    VisibleMap& map) {
    const auto by_region = [&](std::uint32_t a, std::uint32_t b) {
        return ways.region[a] != ways.region[b] ? ways.region[a] < ways.region[b] : a < b;
    };
    std::sort(loose.ends.begin(), loose.ends.end(), by_region);
    std::sort(loose.begins.begin(), loose.begins.end(), by_region);
    // As many of each region end as begin.
    for (std::size_t first = 0, last = 0; first < loose.ends.size(); first = last) {
        const std::uint32_t region = ways.region[loose.ends[first]];
        while (last < loose.ends.size() && ways.region[loose.ends[last]] == region)
            ++last;
        std::vector<std::uint32_t> begins(
            loose.begins.begin() + static_cast<std::ptrdiff_t>(first),
            loose.begins.begin() + static_cast<std::ptrdiff_t>(last));
        const auto distance = [&](std::uint32_t end, std::uint32_t begin) {
            const RationalPoint& from = map.vertices[ways.to(end)];
            const RationalPoint& to = map.vertices[ways.from(begin)];
            const double x = to.x() - from.x();
            const double y = to.y() - from.y();
            return std::sqrt(x * x + y * y);
        };
        const auto nearest = [&](std::uint32_t end) {
            return std::min_element(
                begins.begin(), begins.end(), [&](std::uint32_t a, std::uint32_t b) {
                    return distance(end, a) < distance(end, b);
                });
        };
        std::vector<std::pair<double, std::uint32_t>> ends;
        for (std::size_t i = first; i < last; ++i) {
            stop_if_raised(cancel);
            ends.emplace_back(distance(loose.ends[i], *nearest(loose.ends[i])), loose.ends[i]);
        }
        std::sort(ends.begin(), ends.end());
        for (const auto& [_, end] : ends) {
            stop_if_raised(cancel);
            const auto begin = nearest(end);
            ++map.joined;
            following[end] = *begin;
            begins.erase(begin);
        }
    }
}

/// Of each way the one that follows on the same region's border: at its end the first to the right
/// of the way back.
std::vector<std::uint32_t>
following(const Ways& ways, const Progress& progress, const CancelFlag* cancel, VisibleMap& map) {
    StageProgress stages(progress, 2);
    stages.next(1);
    Leaving leaving = leaving_ways(ways, map.vertices.size(), cancel);
    stages.next(1);
    std::vector<std::uint32_t> result(ways.count());
    std::vector<Loose> loose((map.vertices.size() + block - 1) / block);
    parallel_ranges(loose.size(), 1, [&](std::size_t number, std::size_t) {
        stop_if_raised(cancel);
        const std::size_t end = std::min(map.vertices.size(), (number + 1) * block);
        for (std::size_t vertex = number * block; vertex < end; ++vertex) {
            const std::span<const std::uint32_t> here = leaving.of(vertex);
            for (std::size_t i = 0; i < here.size(); ++i) {
                const std::uint32_t coming = here[i] ^ 1U;
                const std::uint32_t going = here[i == 0 ? here.size() - 1 : i - 1];
                result[coming] = going;
                if (ways.region[coming] != ways.region[going])
                    loose[number].add(coming, going);
            }
        }
    });
    join(joined(loose), ways, cancel, result, map);
    return result;
}

/// Numbers regions in ascending order.
class RegionNumbers {
public:
    void add(VisibleMap::Region region) {
        if (region.source >= first_.size())
            first_.resize(region.source + std::size_t{1}, none);
        for (std::uint32_t i = first_[region.source]; i != none; i = listed_[i].next)
            if (listed_[i].unlit == region.unlit)
                return;
        listed_.push_back({region.unlit, first_[region.source]});
        first_[region.source] = static_cast<std::uint32_t>(listed_.size() - 1);
    }

    /// All that were added.
    std::vector<VisibleMap::Region> numbered() {
        std::vector<VisibleMap::Region> regions;
        regions.reserve(listed_.size());
        for (std::uint32_t source = 0; source < first_.size(); ++source) {
            const std::size_t begin = regions.size();
            for (std::uint32_t i = first_[source]; i != none; i = listed_[i].next)
                regions.push_back({source, listed_[i].unlit});
            std::sort(regions.begin() + static_cast<std::ptrdiff_t>(begin), regions.end());
            for (std::uint32_t i = first_[source]; i != none; i = listed_[i].next) {
                const auto found = std::find(
                    regions.begin() + static_cast<std::ptrdiff_t>(begin),
                    regions.end(),
                    VisibleMap::Region{source, listed_[i].unlit});
                listed_[i].number = static_cast<std::uint32_t>(found - regions.begin());
            }
        }
        return regions;
    }

    std::uint32_t number(VisibleMap::Region region) const {
        std::uint32_t i = first_[region.source];
        while (listed_[i].unlit != region.unlit)
            i = listed_[i].next;
        return listed_[i].number;
    }

private:
    struct Listed {
        LightSet unlit = 0;
        std::uint32_t next = none; ///< of the same source
        std::uint32_t number = 0;
    };

    std::vector<std::uint32_t> first_; ///< of each source
    std::vector<Listed> listed_;
};

Ways ways_of(
    const ScreenScene& scene,
    const VisiblePieces& pieces,
    const Progress& progress,
    const CancelFlag* cancel,
    VisibleMap& map) {
    StageProgress stages(progress, 2);
    const std::size_t count = pieces.pieces.size();
    Ways ways(scene, pieces.pieces);
    // Calls visit(way, region) for the ways of the piece with one on their left.
    const auto for_each_region = [&](std::size_t i, const auto& visit) {
        const VisiblePiece& piece = pieces.pieces[i];
        const UnlitBeside unlit = pieces.unlit_beside(i);
        if (piece.left != no_triangle)
            visit(2 * i, VisibleMap::Region{scene.triangles[piece.left].source, unlit.left});
        if (piece.right != no_triangle)
            visit(2 * i + 1, VisibleMap::Region{scene.triangles[piece.right].source, unlit.right});
    };
    RegionNumbers regions;
    const LongLoop loop(count, stages.next(1), cancel);
    for (std::size_t i = 0; i < count; ++i) {
        loop.turn(i);
        for_each_region(i, [&](std::size_t, VisibleMap::Region region) { regions.add(region); });
    }
    map.regions = regions.numbered();
    stages.next(1);
    parallel_ranges(count, block, [&](std::size_t first, std::size_t last) {
        stop_if_raised(cancel);
        for (std::size_t i = first; i < last; ++i)
            for_each_region(i, [&](std::size_t way, VisibleMap::Region region) {
                ways.region[way] = regions.number(region);
            });
    });
    return ways;
}

bool is_straight_on(ScreenStep a, ScreenStep b) {
    return cross(a, b) == 0;
}

/// The ways beside which something is seen, in parts that have no region in common; those of one
/// part in ascending order.
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
    std::vector<std::uint32_t> parts(regions, none);
    for (std::size_t way = 0; way < ways.count(); ++way)
        if (const std::uint32_t region = ways.region[way];
            region != no_region && parts[region] == none)
            parts[region] = static_cast<std::uint32_t>(way / ways_of_a_part);
    return parts;
}

/// By where each region begins, as ways of one are near each other in memory. Threads share the
/// blocks of ways.
PartedWays parted_by_region(const Ways& ways, std::size_t regions, const CancelFlag* cancel) {
    constexpr std::size_t most_parts = 1024;
    constexpr std::size_t least_of_a_part = 4096;
    constexpr std::size_t ways_of_a_block = 65536;
    const std::size_t ways_of_a_part = std::max(least_of_a_part, ways.count() / most_parts + 1);
    const std::size_t parts = ways.count() / ways_of_a_part + 1;
    const std::size_t blocks = (ways.count() + ways_of_a_block - 1) / ways_of_a_block;
    const std::vector<std::uint32_t> part_of = parts_of_regions(ways, regions, ways_of_a_part);
    const auto for_each_of_block = [&](std::size_t number, const auto& visit) {
        stop_if_raised(cancel);
        const std::size_t end = std::min(ways.count(), (number + 1) * ways_of_a_block);
        for (std::size_t way = number * ways_of_a_block; way < end; ++way)
            if (ways.region[way] != no_region)
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

/// The rings of some regions, as in a VisibleMap that has no others.
struct TracedRings {
    struct Ring {
        std::uint32_t region = 0;
        std::uint32_t first = 0; ///< in ring_vertices; it ends where the next one begins
    };

    std::vector<Ring> rings;
    std::vector<std::uint32_t> ring_vertices;
    std::vector<std::uint32_t> ring_across; ///< empty where that is not asked for
    std::vector<std::size_t> joined_sides;
    std::vector<std::uint32_t> places; ///< of the rings in the whole map

    std::size_t count_of(std::size_t ring) const {
        const std::size_t end =
            ring + 1 < rings.size() ? rings[ring + 1].first : ring_vertices.size();
        return end - rings[ring].first;
    }
};

/// The ring along the way. next[i] is the way that follows way i, and none from now on of those
/// along the ring.
void trace_ring(
    std::uint32_t first,
    const Ways& ways,
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
        const std::uint32_t after = std::exchange(next[way], none);
        const bool is_joined = ways.to(way) != ways.from(after);
        if (is_joined) {
            traced.joined_sides.push_back(traced.ring_vertices.size());
            add(ways.to(way), no_region);
        }
        if (is_joined || !is_straight_on(ways.direction(way), ways.direction(after))
            || ways.region[way ^ 1U] != ways.region[after ^ 1U])
            add(ways.from(after), ways.region[after ^ 1U]);
        way = after;
    } while (way != first);
}

/// The rings of the parts of ways, which no two have in common.
std::vector<TracedRings> traced_rings(
    const Ways& ways,
    const PartedWays& parted,
    RingDetail detail,
    std::vector<std::uint32_t> next,
    const Progress& progress,
    const CancelFlag* cancel) {
    std::vector<TracedRings> parts(parted.starts.size() - 1);
    long_parallel_loop(parts.size(), progress, cancel, 1, [&](std::size_t part) {
        TracedRings traced;
        const std::span<const std::uint32_t> own = parted.of(part);
        traced.ring_vertices.reserve(own.size()); // hardly fewer
        if (detail == RingDetail::with_across)
            traced.ring_across.reserve(own.size());
        const LongLoop loop(own.size(), {}, cancel);
        for (std::size_t i = 0; i < own.size(); ++i) {
            loop.turn(i);
            if (next[own[i]] == none)
                continue;
            traced.rings.push_back(
                {ways.region[own[i]], static_cast<std::uint32_t>(traced.ring_vertices.size())});
            trace_ring(own[i], ways, detail, next, traced);
        }
        parts[part] = std::move(traced);
    });
    return parts;
}

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

/// What a map is made of and, where that need not be kept, the same to be taken apart.
struct MapOrigin {
    const ScreenScene& scene;
    ScreenScene* given_scene;
    const VisiblePieces& pieces;
    VisiblePieces* given_pieces;

    std::vector<PackedPoint> points() const {
        if (given_pieces != nullptr)
            return std::move(given_pieces->points);
        return pieces.points;
    }

    /// When what is beside each way is known: where vertices are is still asked.
    void forget_triangles() const {
        if (given_scene != nullptr)
            free_room(given_scene->triangles);
        if (given_pieces != nullptr)
            free_room(given_pieces->unlit);
    }

    void forget_pieces() const {
        if (given_scene != nullptr)
            free_room(given_scene->vertices);
        if (given_pieces != nullptr)
            free_room(given_pieces->pieces);
    }
};

/// In parts, since what rings are found with takes as much room as they.
std::vector<TracedRings> found_rings(
    const MapOrigin& origin,
    RingDetail detail,
    const Progress& progress,
    const CancelFlag* cancel,
    VisibleMap& map) {
    StageProgress stages(progress, 3);
    const Ways ways = ways_of(origin.scene, origin.pieces, stages.next(1), cancel, map);
    origin.forget_triangles();
    std::vector<std::uint32_t> next = following(ways, stages.next(1), cancel, map);
    const Progress of_rings = stages.next(1);
    const PartedWays parted = parted_by_region(ways, map.regions.size(), cancel);
    return traced_rings(ways, parted, detail, std::move(next), of_rings, cancel);
}

VisibleMap made_map(
    const MapOrigin& origin,
    RingDetail detail,
    const Progress& progress,
    const CancelFlag* cancel) {
    VisibleMap map;
    map.vertices = origin.points();
    std::vector<TracedRings> parts = found_rings(origin, detail, progress, cancel, map);
    origin.forget_pieces();
    join_rings(std::move(parts), detail, map);
    return map;
}

} // namespace

VisibleMap visible_map(
    const ScreenScene& scene,
    const VisiblePieces& pieces,
    const Progress& progress,
    const CancelFlag* cancel) {
    return made_map({scene, nullptr, pieces, nullptr}, RingDetail::with_across, progress, cancel);
}

VisibleMap visible_map(
    ScreenScene&& scene,
    VisiblePieces&& pieces,
    RingDetail detail,
    const Progress& progress,
    const CancelFlag* cancel) {
    ScreenScene own_scene = std::move(scene);
    VisiblePieces own_pieces = std::move(pieces);
    return made_map({own_scene, &own_scene, own_pieces, &own_pieces}, detail, progress, cancel);
}

double doubled_area(const VisibleMap& map, const VisibleMap::Ring& ring) {
    const auto vertices = map.vertices_of(ring);
    if (vertices.empty())
        return 0;
    // About the first, so that little cancels.
    const double x = map.vertices[vertices[0]].x();
    const double y = map.vertices[vertices[0]].y();
    double area = 0;
    for (std::size_t i = 1; i + 1 < vertices.size(); ++i) {
        const RationalPoint& a = map.vertices[vertices[i]];
        const RationalPoint& b = map.vertices[vertices[i + 1]];
        area += (a.x() - x) * (b.y() - y) - (a.y() - y) * (b.x() - x);
    }
    return area;
}

} // namespace vera
