// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/seam_strips.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

namespace vera {

namespace {

constexpr double strip_width = 1; ///< pixels: what smooths edges mixes less far
constexpr double straight = 0.25; ///< how far a border that counts as straight may be off its chord

DrawingPoint way_from(DrawingPoint from, DrawingPoint to) {
    return {to.x - from.x, to.y - from.y};
}

double dot(DrawingPoint a, DrawingPoint b) {
    return a.x * b.x + a.y * b.y;
}

/// Where the straight part of the border from that point on ends.
std::size_t end_of_straight(std::span<const DrawingPoint> border, std::size_t first) {
    std::size_t last = first + 1;
    for (; last + 1 < border.size(); ++last) {
        const DrawingPoint chord = way_from(border[first], border[last + 1]);
        const double length = std::sqrt(dot(chord, chord));
        for (std::size_t i = first + 1; i <= last; ++i) {
            const DrawingPoint way = way_from(border[first], border[i]);
            const double along = dot(way, chord);
            const double across = chord.x * way.y - chord.y * way.x;
            if (along < 0 || along > length * length || std::abs(across) > straight * length)
                return last;
        }
    }
    return last;
}

/// What of the areas lies close to the chord.
std::vector<PointChain>
strips_along(DrawingPoint from, DrawingPoint to, const std::vector<PointChain>& areas) {
    const DrawingPoint chord = way_from(from, to);
    const double length = std::sqrt(dot(chord, chord));
    if (!(length > 0))
        return {};
    const DrawingPoint along = {chord.x / length, chord.y / length};
    const DrawingPoint across = {-along.y, along.x};
    const auto back = [](DrawingPoint way) { return DrawingPoint{-way.x, -way.y}; };
    const HalfPlane sides[] = {
        {along, dot(along, to) + strip_width},
        {back(along), strip_width - dot(along, from)},
        {across, dot(across, from) + strip_width + straight},
        {back(across), strip_width + straight - dot(across, from)}};
    std::vector<PointChain> left = cut_rings(areas, sides[0]);
    for (std::size_t i = 1; i < 4; ++i)
        left = cut_rings(left, sides[i]);
    return left;
}

} // namespace

std::vector<PointChain>
seam_strips(std::span<const DrawingPoint> border, const std::vector<PointChain>& neighbour) {
    std::vector<PointChain> strips;
    for (std::size_t first = 0; first + 1 < border.size();) {
        const std::size_t last = end_of_straight(border, first);
        std::ranges::move(
            strips_along(border[first], border[last], neighbour), std::back_inserter(strips));
        first = last;
    }
    return strips;
}

} // namespace vera
