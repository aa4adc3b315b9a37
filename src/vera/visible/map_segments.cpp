// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/map_segments.h"

#include "vera/base/long_loop.h"
#include "vera/exact/rational_orientation.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace vera {

namespace {

/// Coordinates in doubles are off by no more.
constexpr double point_error = 0x1p-30;

/// Of points that are asked about, bits of a coordinate behind those of the grid.
constexpr int fraction_bits = 20;

/// A coordinate as a whole number and a numerator over 2^fraction_bits.
struct FineCoordinate {
    std::int32_t whole = 0;
    std::int64_t numerator = 0;
};

FineCoordinate fine(double value) {
    constexpr std::int64_t parts = std::int64_t{1} << fraction_bits;
    const auto all = static_cast<std::int64_t>(std::floor(
        std::clamp(value, 0.0, static_cast<double>(screen_size)) * static_cast<double>(parts)
        + 0.5));
    return {static_cast<std::int32_t>(all / parts), all % parts};
}

struct Numbered {
    MapPoint point;
    std::uint32_t vertex = 0; ///< of the map
};

/// One side of a segment.
struct Half {
    std::uint32_t low = 0; ///< of the segment's ends, which is vertices of the map
    std::uint32_t high = 0;
    bool is_above = false; ///< lies to the left of the way from low to high
    std::uint32_t region = 0;

    friend auto operator<=>(const Half&, const Half&) = default;
};

Half half_of(std::uint32_t from, std::uint32_t to, std::uint32_t region) {
    return {std::min(from, to), std::max(from, to), from < to, region};
}

/// The sides that are left of those between the same ends, and more of them: what is above one and
/// below another of them is not parted by them.
MapSegment merged(std::span<const Half> halves) {
    MapSegment result = {halves[0].low, halves[0].high};
    const auto count = [&](bool is_above, std::uint32_t region) {
        return std::count_if(halves.begin(), halves.end(), [&](const Half& half) {
            return half.is_above == is_above && half.region == region;
        });
    };
    for (const Half& half : halves)
        if (count(half.is_above, half.region) > count(!half.is_above, half.region))
            (half.is_above ? result.above : result.below) = half.region;
    return result;
}

/// Where ways round what is seen had to be joined by straight ones, these often lie upon borders.
std::vector<MapSegment> merged_sides(
    const VisibleMap& map, const std::vector<MapSegment>& sides, std::vector<Half> joined) {
    std::vector<Half> halves = std::move(joined);
    const auto add = [&](std::uint32_t from, std::uint32_t to, std::uint32_t region) {
        if (region != no_region)
            halves.push_back(half_of(from, to, region));
    };
    for (const MapSegment& side : sides) {
        add(side.begin, side.end, side.above);
        add(side.end, side.begin, side.below);
    }
    std::sort(halves.begin(), halves.end());
    std::vector<MapSegment> result;
    for (std::size_t first = 0, last = 0; first < halves.size(); first = last) {
        while (last < halves.size() && halves[last].low == halves[first].low
               && halves[last].high == halves[first].high)
            ++last;
        const MapSegment segment = merged(std::span(halves).subspan(first, last - first));
        if (segment.above != segment.below
            && map.vertices[segment.begin] != map.vertices[segment.end])
            result.push_back(segment);
    }
    return result;
}

/// The sides of the map's rings, each border on that side which has the smaller region.
std::vector<MapSegment> sides_of(const VisibleMap& map, const CancelFlag* cancel) {
    std::vector<MapSegment> sides;
    std::vector<std::size_t> joined = map.joined_sides;
    std::sort(joined.begin(), joined.end());
    std::vector<Half> joined_halves;
    const LongLoop loop(map.rings.size(), {}, cancel);
    for (std::size_t number = 0; number < map.rings.size(); ++number) {
        loop.turn(number);
        const VisibleMap::Ring& ring = map.rings[number];
        const auto vertices = map.vertices_of(ring);
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const std::size_t place = ring.first + i;
            const std::uint32_t from = vertices[i];
            const std::uint32_t to = vertices[i + 1 == vertices.size() ? 0 : i + 1];
            const std::uint32_t across = map.ring_across[place];
            if (std::binary_search(joined.begin(), joined.end(), place))
                joined_halves.push_back(half_of(from, to, ring.region));
            else if (ring.region < across)
                sides.push_back({from, to, ring.region, across});
        }
    }
    if (joined.empty())
        return sides;
    return merged_sides(map, sides, std::move(joined_halves));
}

} // namespace

MapPoint map_point(const RationalPoint& point) {
    return {point, point.x(), point.y()};
}

MapPoint map_point(double x, double y) {
    const FineCoordinate fine_x = fine(x);
    const FineCoordinate fine_y = fine(y);
    return map_point(
        {{fine_x.whole, fine_y.whole},
         fine_x.numerator,
         fine_y.numerator,
         std::int64_t{1} << fraction_bits});
}

int order_by_x(const MapPoint& a, const MapPoint& b) {
    if (std::abs(a.x - b.x) > 2 * point_error)
        return a.x < b.x ? -1 : 1;
    if (a.exact.whole.x != b.exact.whole.x)
        return a.exact.whole.x < b.exact.whole.x ? -1 : 1;
    return order(
        SegmentPlace{a.exact.x_numerator, a.exact.denominator},
        SegmentPlace{b.exact.x_numerator, b.exact.denominator});
}

int order(const MapPoint& a, const MapPoint& b) {
    if (std::abs(a.x - b.x) > 2 * point_error)
        return a.x < b.x ? -1 : 1;
    return order(a.exact, b.exact);
}

int side(const MapPoint& from, const MapPoint& to, const MapPoint& point) {
    const double to_x = to.x - from.x;
    const double to_y = to.y - from.y;
    const double x = point.x - from.x;
    const double y = point.y - from.y;
    const double turn = to_x * y - to_y * x;
    // Each difference is off by 2 point_error, a product by that much of its other factor, and by
    // its own rounding, which is less still.
    const double size = std::abs(to_x) + std::abs(to_y) + std::abs(x) + std::abs(y);
    if (std::abs(turn) > 8 * point_error * (size + 1))
        return turn > 0 ? 1 : -1;
    return orientation(from.exact, to.exact, point.exact);
}

bool MapSegments::is_above(std::uint32_t a, std::uint32_t b) const {
    const auto above_by = [&](std::uint32_t one, std::uint32_t other) {
        const int at_begin = side(other, begin(one));
        return at_begin != 0 ? at_begin : side(other, end(one));
    };
    // By the one that begins later.
    const bool is_later = segments[a].begin >= segments[b].begin;
    const int result = is_later ? above_by(a, b) : -above_by(b, a);
    return result != 0 ? result > 0 : a > b;
}

MapSegments map_segments(const VisibleMap& map, const CancelFlag* cancel) {
    MapSegments result;
    result.segments = sides_of(map, cancel);
    std::vector<std::uint32_t> used;
    used.reserve(2 * result.segments.size());
    for (const MapSegment& segment : result.segments) {
        used.push_back(segment.begin);
        used.push_back(segment.end);
    }
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    std::vector<Numbered> points;
    points.reserve(used.size());
    for (const std::uint32_t vertex : used)
        points.push_back({map_point(map.vertices[vertex]), vertex});
    stop_if_raised(cancel);
    std::sort(points.begin(), points.end(), [](const Numbered& a, const Numbered& b) {
        return order(a.point, b.point) < 0;
    });
    stop_if_raised(cancel);
    std::vector<std::uint32_t> number(map.vertices.size());
    result.points.reserve(points.size());
    for (const Numbered& point : points) {
        number[point.vertex] = static_cast<std::uint32_t>(result.points.size());
        result.points.push_back(point.point);
    }
    for (MapSegment& segment : result.segments) {
        segment.begin = number[segment.begin];
        segment.end = number[segment.end];
        if (segment.end < segment.begin) {
            std::swap(segment.begin, segment.end);
            std::swap(segment.above, segment.below);
        }
    }
    return result;
}

} // namespace vera
