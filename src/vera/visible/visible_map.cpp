// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/visible_map.h"

#include "vera/base/free_room.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/base/spent_pages.h"
#include "vera/visible/open_points.h"
#include "vera/visible/region_numbers.h"
#include "vera/visible/traced_rings.h"
#include "vera/visible/ways.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

namespace vera {

namespace {

constexpr std::size_t block = 4096; ///< vertices or pieces that a thread takes at a time

/// Whether a lies in the half turn that begins with the direction to the right.
bool is_upper(ScreenStep a) {
    return a.y > 0 || (a.y == 0 && a.x > 0);
}

bool turns_before(ScreenStep a, ScreenStep b) {
    if (is_upper(a) != is_upper(b))
        return is_upper(a);
    return cross(a, b) > 0;
}

/// The ways that leave each vertex, as lists. What is found for a way may be put in the place of
/// next[way] when the list of its vertex was gone through.
struct Leaving {
    Leaving(const Ways& ways, std::size_t vertex_count)
        : first(vertex_count, no_way)
        , next(ways.count()) {
        for (auto way = static_cast<std::uint32_t>(ways.count()); way-- > 0;)
            next[way] = std::exchange(first[ways.from(way)], way);
    }

    /// In their order round the vertex to the left.
    void list_at(std::size_t vertex, const Ways& ways, std::vector<std::uint32_t>& here) const {
        here.clear();
        for (std::uint32_t way = first[vertex]; way != no_way; way = next[way])
            here.push_back(way);
        std::sort(here.begin(), here.end(), [&](std::uint32_t a, std::uint32_t b) {
            return turns_before(ways.direction(a), ways.direction(b));
        });
    }

    std::vector<std::uint32_t> first; ///< of each vertex
    std::vector<std::uint32_t> next;  ///< of each way
};

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

/// Joins loose ways by straight ones.
class Joining {
public:
    Joining(
        const Ways& ways,
        const CancelFlag* cancel,
        std::vector<std::uint32_t>& following,
        VisibleMap& map)
        : ways_(ways)
        , cancel_(cancel)
        , following_(following)
        , map_(map) {}

    /// Borders between two regions of which no piece was found come first: such a one leads from a
    /// place where the one region ends and the other begins to one where it is the other way round,
    /// and both get the same straight way. What is left, at places where three regions or more meet
    /// so, is joined region by region. Both are done of short ways before they are of others, so
    /// that none of what is near leads far away.
    void join(Loose loose) {
        for (const double most : {short_way, std::numeric_limits<double>::infinity()})
            loose = join_each_region(join_borders(loose, most), most);
    }

private:
    /// A place where `low` and `high` are the regions that end and begin, the smaller number first.
    struct Break {
        std::uint32_t low = 0;
        std::uint32_t high = 0;
        std::uint32_t number = 0; ///< in Loose
    };

    Loose join_borders(const Loose& loose, double most) {
        std::vector<Break> breaks;
        for (std::uint32_t i = 0; i < loose.ends.size(); ++i) {
            const auto [low, high] = std::minmax({region(loose.ends[i]), region(loose.begins[i])});
            breaks.push_back({low, high, i});
        }
        const auto key = [](const Break& one) { return std::tuple(one.low, one.high, one.number); };
        std::sort(breaks.begin(), breaks.end(), [&](const Break& a, const Break& b) {
            return key(a) < key(b);
        });
        std::vector<bool> is_joined(breaks.size());
        for (std::size_t first = 0, last = 0; first < breaks.size(); first = last) {
            const Break& one = breaks[first];
            std::vector<std::uint32_t> low_ends;
            std::vector<std::uint32_t> high_ends;
            for (; last < breaks.size() && breaks[last].low == one.low
                 && breaks[last].high == one.high;
                 ++last) {
                const std::uint32_t i = breaks[last].number;
                (region(loose.ends[i]) == one.low ? low_ends : high_ends).push_back(i);
            }
            const auto distance = [&](std::uint32_t a, std::uint32_t b) {
                return distance_of(loose.ends[a], loose.begins[b]);
            };
            pair_nearest(
                low_ends, high_ends, most, distance, [&](std::uint32_t a, std::uint32_t b) {
                    follow(loose.ends[a], loose.begins[b]);
                    follow(loose.ends[b], loose.begins[a]);
                    is_joined[a] = is_joined[b] = true;
                });
        }
        Loose left;
        for (std::size_t i = 0; i < loose.ends.size(); ++i)
            if (!is_joined[i])
                left.add(loose.ends[i], loose.begins[i]);
        return left;
    }

    Loose join_each_region(Loose loose, double most) {
        const auto by_region = [&](std::uint32_t a, std::uint32_t b) {
            return region(a) != region(b) ? region(a) < region(b) : a < b;
        };
        std::sort(loose.ends.begin(), loose.ends.end(), by_region);
        std::sort(loose.begins.begin(), loose.begins.end(), by_region);
        // As many of each region end as begin.
        const auto begins_at = [&](std::size_t i) {
            return loose.begins.begin() + static_cast<std::ptrdiff_t>(i);
        };
        const auto ends_at = [&](std::size_t i) {
            return loose.ends.begin() + static_cast<std::ptrdiff_t>(i);
        };
        Loose left;
        for (std::size_t first = 0, last = 0; first < loose.ends.size(); first = last) {
            while (last < loose.ends.size()
                   && region(loose.ends[last]) == region(loose.ends[first]))
                ++last;
            const Loose far = pair_nearest(
                {ends_at(first), ends_at(last)},
                {begins_at(first), begins_at(last)},
                most,
                [&](std::uint32_t end, std::uint32_t begin) { return distance_of(end, begin); },
                [&](std::uint32_t end, std::uint32_t begin) {
                    map_.longest_join = std::max(map_.longest_join, distance_of(end, begin));
                    follow(end, begin);
                });
            for (std::size_t i = 0; i < far.ends.size(); ++i)
                left.add(far.ends[i], far.begins[i]);
        }
        return left;
    }

    /// Pairs each end with the nearest beginning that is left, as long as there is one and it is no
    /// farther than most. Those whose nearest is the nearest come first: none takes the one that
    /// belongs to another. Returns the others.
    template <typename Distance, typename Visit>
    Loose pair_nearest(
        const std::vector<std::uint32_t>& ends,
        std::vector<std::uint32_t> begins,
        double most,
        const Distance& distance,
        const Visit& visit) const {
        Loose left;
        left.begins = std::move(begins);
        std::vector<std::uint32_t>& free = left.begins;
        const auto nearest = [&](std::uint32_t end) {
            return std::min_element(
                free.begin(), free.end(), [&](std::uint32_t a, std::uint32_t b) {
                    return distance(end, a) < distance(end, b);
                });
        };
        std::vector<std::pair<double, std::uint32_t>> in_turn;
        for (const std::uint32_t end : ends) {
            stop_if_raised(cancel_);
            in_turn.emplace_back(free.empty() ? 0 : distance(end, *nearest(end)), end);
        }
        std::sort(in_turn.begin(), in_turn.end());
        for (const auto& [_, end] : in_turn) {
            stop_if_raised(cancel_);
            const auto begin = nearest(end);
            if (begin == free.end() || distance(end, *begin) > most) {
                left.ends.push_back(end);
                continue;
            }
            visit(end, *begin);
            free.erase(begin);
        }
        return left;
    }

    std::uint32_t region(std::uint32_t way) const { return ways_.region[way]; }

    double distance_of(std::uint32_t end, std::uint32_t begin) const {
        const RationalPoint& from = map_.vertices[ways_.to(end)];
        const RationalPoint& to = map_.vertices[ways_.from(begin)];
        const double x = to.x() - from.x();
        const double y = to.y() - from.y();
        return std::sqrt(x * x + y * y);
    }

    void follow(std::uint32_t end, std::uint32_t begin) {
        ++map_.joined;
        following_[end] = begin;
    }

    const Ways& ways_;
    const CancelFlag* cancel_;
    std::vector<std::uint32_t>& following_;
    VisibleMap& map_;
};

/// Of each way the one that follows on the same region's border: at its end the first to the right
/// of the way back.
std::vector<std::uint32_t>
following(const Ways& ways, const Progress& progress, const CancelFlag* cancel, VisibleMap& map) {
    StageProgress stages(progress, 2);
    stages.next(1);
    Leaving leaving(ways, map.vertices.size());
    stages.next(1);
    std::vector<Loose> loose((map.vertices.size() + block - 1) / block);
    parallel_ranges(loose.size(), 1, [&](std::size_t number, std::size_t) {
        stop_if_raised(cancel);
        const std::size_t end = std::min(map.vertices.size(), (number + 1) * block);
        std::vector<std::uint32_t> here;
        for (std::size_t vertex = number * block; vertex < end; ++vertex) {
            leaving.list_at(vertex, ways, here);
            for (std::size_t i = 0; i < here.size(); ++i) {
                const std::uint32_t coming = here[i] ^ 1U;
                const std::uint32_t going = here[i == 0 ? here.size() - 1 : i - 1];
                leaving.next[here[i]] = going;
                if (ways.region[coming] != ways.region[going])
                    loose[number].add(coming, going);
            }
        }
    });
    free_room(leaving.first);
    std::vector<std::uint32_t> result = std::move(leaving.next);
    for (std::size_t i = 0; i < result.size(); i += 2)
        std::swap(result[i], result[i + 1]); // of the way that comes, in place of the one back
    Joining(ways, cancel, result, map).join(joined(loose));
    return result;
}

/// What a map is made of and, where that need not be kept, the same to be taken apart.
struct MapOrigin {
    const ScreenScene& scene;
    ScreenScene* given_scene;
    const VisiblePieces& pieces;
    VisiblePieces* given_pieces;
    std::vector<PackedPoint>* given_points;
    std::vector<UnlitBeside>* given_unlit;

    std::vector<PackedPoint> points() const {
        if (given_points != nullptr)
            return std::move(*given_points);
        return pieces.points;
    }

    /// These, when there are ways along them: their memory, not their room.
    void forget_pieces(std::size_t first, std::size_t last) const {
        if (given_pieces != nullptr)
            give_back_spent(given_pieces->pieces, first, last);
    }

    /// When there are all ways.
    void forget() const {
        if (given_scene != nullptr) {
            free_room(given_scene->triangles);
            free_room(given_scene->vertices);
        }
        if (given_pieces != nullptr)
            free_room(given_pieces->pieces);
        if (given_unlit != nullptr)
            free_room(*given_unlit);
        give_back_freed_memory();
    }
};

/// What is seen beside pieces, in ascending order.
std::vector<std::uint32_t> seen_sources(
    const ScreenScene& scene,
    const VisiblePieces& pieces,
    const Progress& progress,
    const CancelFlag* cancel) {
    std::uint32_t most = 0;
    for (const ScreenTriangle& triangle : scene.triangles)
        most = std::max(most, triangle.source);
    // Each part of the pieces marks what it sees in a list of its own.
    constexpr std::size_t parts = 4;
    std::array<std::vector<std::uint8_t>, parts> is_seen;
    const std::size_t count = pieces.pieces.size();
    long_parallel_loop(parts, progress, cancel, 1, [&](std::size_t part) {
        is_seen[part].resize(most + std::size_t{1});
        for (std::size_t i = part * count / parts; i < (part + 1) * count / parts; ++i)
            for (const std::uint32_t triangle : {pieces.pieces[i].left, pieces.pieces[i].right})
                if (triangle != no_triangle)
                    is_seen[part][scene.triangles[triangle].source] = 1;
    });
    std::vector<std::uint32_t> sources;
    for (std::uint32_t source = 0; source <= most; ++source)
        if (std::ranges::any_of(is_seen, [&](const auto& seen) { return seen[source] != 0; }))
            sources.push_back(source);
    return sources;
}

Ways ways_of(
    const MapOrigin& origin, const Progress& progress, const CancelFlag* cancel, VisibleMap& map) {
    StageProgress stages(progress, 2);
    const ScreenScene& scene = origin.scene;
    const VisiblePieces& pieces = origin.pieces;
    const std::size_t count = pieces.pieces.size();
    Ways ways(count);
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
    const Progress progress_of_regions = stages.next(1);
    if (pieces.unlit.empty()) {
        for (const std::uint32_t source : seen_sources(scene, pieces, progress_of_regions, cancel))
            regions.add({source, 0});
    } else {
        const LongLoop loop(count, progress_of_regions, cancel);
        for (std::size_t i = 0; i < count; ++i) {
            loop.turn(i);
            for_each_region(
                i, [&](std::size_t, VisibleMap::Region region) { regions.add(region); });
        }
    }
    map.regions = regions.numbered();
    stages.next(1);
    const auto add = [&](std::size_t i) {
        const VisiblePiece& piece = pieces.pieces[i];
        ways.ends[i] = {piece.from, piece.to};
        ways.steps[i] =
            step(scene.vertices[piece.edge.begin].point, scene.vertices[piece.edge.end].point);
        ways.region[2 * i] = ways.region[2 * i + 1] = no_region;
        for_each_region(i, [&](std::size_t way, VisibleMap::Region region) {
            ways.region[way] = regions.number(region);
        });
    };
    // A few at a time, whose ways may take the room of the pieces before.
    constexpr std::size_t at_a_time = 16 * block;
    for (std::size_t begin = 0; begin < count; begin += at_a_time) {
        const std::size_t end = std::min(count, begin + at_a_time);
        ways.resize(end);
        parallel_ranges(end - begin, block, [&](std::size_t first, std::size_t last) {
            stop_if_raised(cancel);
            for (std::size_t i = begin + first; i < begin + last; ++i)
                add(i);
        });
        origin.forget_pieces(begin, end);
    }
    return ways;
}

std::vector<TracedRings> found_rings(
    const MapOrigin& origin,
    RingDetail detail,
    const Progress& progress,
    const CancelFlag* cancel,
    VisibleMap& map) {
    StageProgress stages(progress, 3);
    Ways ways = ways_of(origin, stages.next(1), cancel, map);
    origin.forget();
    std::vector<std::uint32_t> next = following(ways, stages.next(1), cancel, map);
    return traced_rings(
        std::move(ways), map.regions.size(), detail, std::move(next), stages.next(1), cancel);
}

VisibleMap made_map(
    const MapOrigin& origin,
    RingDetail detail,
    const Progress& progress,
    const CancelFlag* cancel) {
    VisibleMap map;
    map.vertices = origin.points();
    std::vector<TracedRings> parts = found_rings(origin, detail, progress, cancel, map);
    join_rings(std::move(parts), detail, map);
    return map;
}

} // namespace

VisibleMap visible_map(
    const ScreenScene& scene,
    const VisiblePieces& pieces,
    const Progress& progress,
    const CancelFlag* cancel) {
    return made_map(
        {scene, nullptr, pieces, nullptr, nullptr, nullptr},
        RingDetail::with_across,
        progress,
        cancel);
}

VisibleMap visible_map_with_points_of(
    VisiblePieces& pieces,
    const ScreenScene& scene,
    const Progress& progress,
    const CancelFlag* cancel) {
    return made_map(
        {scene, nullptr, pieces, nullptr, &pieces.points, &pieces.unlit},
        RingDetail::with_across,
        progress,
        cancel);
}

VisibleMap visible_map(
    ScreenScene&& scene,
    VisiblePieces&& pieces,
    RingDetail detail,
    const Progress& progress,
    const CancelFlag* cancel) {
    ScreenScene own_scene = std::move(scene);
    VisiblePieces own_pieces = std::move(pieces);
    return made_map(
        {own_scene, &own_scene, own_pieces, &own_pieces, &own_pieces.points, &own_pieces.unlit},
        detail,
        progress,
        cancel);
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
