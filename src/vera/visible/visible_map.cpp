// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace vera {

namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

std::uint64_t hash_of(const RationalPoint& point) {
    std::uint64_t hash = 0;
    const auto mix = [&](std::uint64_t value) {
        hash = (hash ^ value) * 0x9e3779b97f4a7c15U;
        hash ^= hash >> 32U;
    };
    mix(static_cast<std::uint64_t>(point.whole.x) << 32U
        | static_cast<std::uint32_t>(point.whole.y));
    mix(static_cast<std::uint64_t>(point.x_numerator));
    mix(static_cast<std::uint64_t>(point.y_numerator));
    mix(static_cast<std::uint64_t>(point.denominator));
    return hash;
}

/// Numbers points in the order in which they come, equal ones alike.
class PointNumbers {
public:
    PointNumbers(std::vector<RationalPoint>& points, std::size_t most)
        : points_(points) {
        std::size_t size = 16;
        while (size < 2 * most)
            size *= 2;
        places_.assign(size, none);
    }

    std::uint32_t number(const RationalPoint& point) {
        const std::size_t mask = places_.size() - 1;
        std::size_t place = hash_of(point) & mask;
        while (places_[place] != none) {
            if (points_[places_[place]] == point)
                return places_[place];
            place = (place + 1) & mask;
        }
        places_[place] = static_cast<std::uint32_t>(points_.size());
        points_.push_back(point);
        return places_[place];
    }

private:
    std::vector<RationalPoint>& points_;
    std::vector<std::uint32_t> places_;
};

/// The two ways along a piece: 2 i with, 2 i + 1 against its edge.
struct Ways {
    std::vector<std::uint32_t> from; ///< where they begin
    std::vector<ScreenStep> direction;
    std::vector<std::uint32_t> source; ///< seen on the left

    std::uint32_t to(std::uint32_t way) const { return from[way ^ 1U]; }
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

Leaving leaving_ways(const Ways& ways, std::size_t vertex_count) {
    Leaving leaving;
    leaving.starts.resize(vertex_count + 1);
    for (const std::uint32_t vertex : ways.from)
        ++leaving.starts[vertex + 1];
    std::partial_sum(leaving.starts.begin(), leaving.starts.end(), leaving.starts.begin());
    leaving.ways.resize(ways.from.size());
    std::vector<std::uint32_t> next(leaving.starts.begin(), leaving.starts.end() - 1);
    for (std::uint32_t way = 0; way < ways.from.size(); ++way)
        leaving.ways[next[ways.from[way]]++] = way;
    for (std::size_t vertex = 0; vertex < vertex_count; ++vertex) {
        const std::span<std::uint32_t> here = leaving.of(vertex);
        std::sort(here.begin(), here.end(), [&](std::uint32_t a, std::uint32_t b) {
            return turns_before(ways.direction[a], ways.direction[b]);
        });
    }
    return leaving;
}

/// Ways that end, or begin, where none of their source goes on.
struct Loose {
    std::vector<std::uint32_t> ends;
    std::vector<std::uint32_t> begins;
};

/// Joins each end to the nearest beginning of its source that is left. Those whose nearest is the
/// nearest come first: none takes the one that belongs to another.
void join(Loose loose, const Ways& ways, std::vector<std::uint32_t>& following, VisibleMap& map) {
    const auto by_source = [&](std::uint32_t a, std::uint32_t b) {
        return ways.source[a] != ways.source[b] ? ways.source[a] < ways.source[b] : a < b;
    };
    std::sort(loose.ends.begin(), loose.ends.end(), by_source);
    std::sort(loose.begins.begin(), loose.begins.end(), by_source);
    // As many of each source end as begin.
    for (std::size_t first = 0, last = 0; first < loose.ends.size(); first = last) {
        const std::uint32_t source = ways.source[loose.ends[first]];
        while (last < loose.ends.size() && ways.source[loose.ends[last]] == source)
            ++last;
        std::vector<std::uint32_t> begins(
            loose.begins.begin() + static_cast<std::ptrdiff_t>(first),
            loose.begins.begin() + static_cast<std::ptrdiff_t>(last));
        const auto distance = [&](std::uint32_t end, std::uint32_t begin) {
            const RationalPoint& from = map.vertices[ways.to(end)];
            const RationalPoint& to = map.vertices[ways.from[begin]];
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
        for (std::size_t i = first; i < last; ++i)
            ends.emplace_back(distance(loose.ends[i], *nearest(loose.ends[i])), loose.ends[i]);
        std::sort(ends.begin(), ends.end());
        for (const auto& [_, end] : ends) {
            const auto begin = nearest(end);
            ++map.joined;
            following[end] = *begin;
            begins.erase(begin);
        }
    }
}

/// Of each way the one that follows on the same region's border: at its end the first to the right
/// of the way back.
std::vector<std::uint32_t> following(const Ways& ways, VisibleMap& map) {
    Leaving leaving = leaving_ways(ways, map.vertices.size());
    std::vector<std::uint32_t> result(ways.from.size());
    Loose loose;
    for (std::size_t vertex = 0; vertex < map.vertices.size(); ++vertex) {
        const std::span<const std::uint32_t> here = leaving.of(vertex);
        for (std::size_t i = 0; i < here.size(); ++i) {
            const std::uint32_t coming = here[i] ^ 1U;
            const std::uint32_t going = here[i == 0 ? here.size() - 1 : i - 1];
            result[coming] = going;
            if (ways.source[coming] != ways.source[going]) {
                loose.ends.push_back(coming);
                loose.begins.push_back(going);
            }
        }
    }
    join(std::move(loose), ways, result, map);
    return result;
}

Ways ways_of(const ScreenScene& scene, const VisiblePieces& pieces, VisibleMap& map) {
    const std::size_t count = pieces.pieces.size();
    Ways ways;
    ways.from.resize(2 * count);
    ways.direction.resize(2 * count);
    ways.source.resize(2 * count);
    PointNumbers numbers(map.vertices, count + count / 2);
    const auto source_of = [&](std::uint32_t triangle) {
        return triangle == no_triangle ? no_source : scene.triangles[triangle].source;
    };
    for (std::size_t i = 0; i < count; ++i) {
        const VisiblePiece& piece = pieces.pieces[i];
        map.piece_ends.push_back({numbers.number(piece.from), numbers.number(piece.to)});
        ways.from[2 * i] = map.piece_ends.back()[0];
        ways.from[2 * i + 1] = map.piece_ends.back()[1];
        ways.direction[2 * i] = step(piece.edge_begin, piece.edge_end);
        ways.direction[2 * i + 1] = step(piece.edge_end, piece.edge_begin);
        ways.source[2 * i] = source_of(piece.left);
        ways.source[2 * i + 1] = source_of(piece.right);
    }
    return ways;
}

bool is_straight_on(ScreenStep a, ScreenStep b) {
    return cross(a, b) == 0;
}

} // namespace

VisibleMap visible_map(const ScreenScene& scene, const VisiblePieces& pieces) {
    VisibleMap map;
    const Ways ways = ways_of(scene, pieces, map);
    const std::vector<std::uint32_t> next = following(ways, map);
    std::vector<std::uint8_t> done(ways.from.size());
    const auto add = [&](std::uint32_t vertex, std::uint32_t across) {
        map.ring_vertices.push_back(vertex);
        map.ring_across.push_back(across);
    };
    for (std::uint32_t first = 0; first < ways.from.size(); ++first) {
        if (done[first] != 0 || ways.source[first] == no_source)
            continue;
        VisibleMap::Ring ring = {ways.source[first], map.ring_vertices.size(), 0};
        std::uint32_t way = first;
        do {
            done[way] = 1;
            const std::uint32_t after = next[way];
            const bool is_joined = ways.to(way) != ways.from[after];
            if (is_joined)
                add(ways.to(way), no_source);
            if (is_joined || !is_straight_on(ways.direction[way], ways.direction[after])
                || ways.source[way ^ 1U] != ways.source[after ^ 1U])
                add(ways.from[after], ways.source[after ^ 1U]);
            way = after;
        } while (way != first);
        ring.count = map.ring_vertices.size() - ring.first;
        map.rings.push_back(ring);
    }
    std::stable_sort(map.rings.begin(), map.rings.end(), [](const auto& a, const auto& b) {
        return a.source < b.source;
    });
    return map;
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
