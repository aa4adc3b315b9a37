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

/// The sides of the map's rings, each border on that side which has the smaller region.
std::vector<MapSegment> sides_of(const VisibleMap& map, const CancelFlag* cancel) {
    std::vector<MapSegment> sides;
    std::vector<std::size_t> joined = map.joined_sides;
    std::sort(joined.begin(), joined.end());
    const LongLoop loop(map.rings.size(), {}, cancel);
    for (std::size_t number = 0; number < map.rings.size(); ++number) {
        loop.turn(number);
        const VisibleMap::Ring& ring = map.rings[number];
        const auto vertices = map.vertices_of(ring);
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const std::size_t place = ring.first + i;
            const std::uint32_t across = map.ring_across[place];
            if (ring.region < across && !std::binary_search(joined.begin(), joined.end(), place))
                sides.push_back(
                    {vertices[i],
                     vertices[i + 1 == vertices.size() ? 0 : i + 1],
                     ring.region,
                     across});
        }
    }
    return sides;
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
