// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/seam_strips.h"

#include "vera/drawing/elliptic_arc.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
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
std::size_t end_of_straight(std::span<const BorderPoint> border, std::size_t first) {
    std::size_t last = first + 1;
    for (; last + 1 < border.size(); ++last) {
        const DrawingPoint chord = way_from(border[first], border[last + 1]);
        const double length = std::sqrt(dot(chord, chord));
        if (!(length > 0)) // all the way round something narrow
            return last;
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

DrawingPoint unit(DrawingPoint way) {
    const double length = std::sqrt(dot(way, way));
    return {way.x / length, way.y / length};
}

/// The first of the points that is not near to the one at which the way along them begins: what is
/// shorter tells no direction.
template <typename PointAt>
DrawingPoint point_ahead(DrawingPoint begin, std::size_t count, const PointAt& point_at) {
    constexpr double near = 0.1; // pixels
    DrawingPoint ahead = begin;
    for (std::size_t i = 1; i < count; ++i) {
        ahead = point_at(i);
        if (const DrawingPoint way = way_from(begin, ahead); dot(way, way) >= near * near)
            break;
    }
    return ahead;
}

/// One end of a border, and the half plane beyond which what lies in the neighbour is nearer to
/// that one's next side than to the border.
struct BorderEnd {
    DrawingPoint point;
    std::optional<HalfPlane> half; ///< none where the sides have one direction

    /// That of sides towards these points.
    BorderEnd(DrawingPoint end, DrawingPoint along, DrawingPoint other)
        : point(end) {
        if (along == end || other == end)
            return;
        const DrawingPoint a = unit(way_from(end, along));
        const DrawingPoint b = unit(way_from(end, other));
        // The bisector, also of an angle that is more than a half turn.
        if (const DrawingPoint normal = way_from(a, b); dot(normal, normal) > 0)
            half = HalfPlane{normal, dot(normal, end)};
    }

    /// What is to be left of strips along a chord that begins at the one place and goes towards the
    /// other: where it comes near to the end, what lies in the half plane. One that leaves that, as
    /// along the other side of a thin neighbour, is not cut farther away.
    std::vector<BorderRing>
    cut(const std::vector<BorderRing>& strips, DrawingPoint place, DrawingPoint towards) const {
        constexpr double reach = 2 * strip_width;
        const DrawingPoint way = way_from(point, place);
        if (!half || dot(way, way) > reach * reach)
            return strips;
        if (place == point || dot(half->normal, towards) <= half->reach)
            return cut_rings(strips, *half);
        const DrawingPoint along = unit(way_from(place, towards));
        const HalfPlane near = {along, dot(along, point) + reach};
        std::vector<BorderRing> left = cut_rings(cut_rings(strips, near), *half);
        std::ranges::move(
            cut_rings(strips, {{-along.x, -along.y}, -near.reach}), std::back_inserter(left));
        return left;
    }
};

/// The ends of the border, where it is not all of one of the neighbour's rings.
std::vector<BorderEnd>
ends_of(std::span<const BorderPoint> border, const std::vector<BorderRing>& neighbour) {
    // The neighbour's rings go along it the other way.
    const DrawingPoint& first = border.front();
    const DrawingPoint& last = border.back();
    std::vector<BorderEnd> ends;
    if (first == last)
        return ends;
    const auto along_border = [&](std::size_t i) { return border[i]; };
    const auto back_along_border = [&](std::size_t i) { return border[border.size() - 1 - i]; };
    for (const BorderRing& ring : neighbour)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const auto ahead = [&](std::size_t j) { return ring[(i + j) % ring.size()]; };
            const auto back = [&](std::size_t j) {
                return ring[(i + ring.size() - j) % ring.size()];
            };
            if (ring[i] == first && back(1) == border[1])
                ends.emplace_back(
                    first,
                    point_ahead(first, border.size(), along_border),
                    point_ahead(first, ring.size(), ahead));
            if (ring[i] == last && ahead(1) == border[border.size() - 2])
                ends.emplace_back(
                    last,
                    point_ahead(last, border.size(), back_along_border),
                    point_ahead(last, ring.size(), back));
        }
    return ends;
}

/// What of the areas lies close to the chord.
std::vector<BorderRing>
strips_along(DrawingPoint from, DrawingPoint to, const std::vector<BorderRing>& areas) {
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
    std::vector<BorderRing> left = cut_rings(areas, sides[0]);
    for (std::size_t i = 1; i < 4; ++i)
        left = cut_rings(left, sides[i]);
    return left;
}

} // namespace

void reach_back(
    std::span<const BorderPoint> border,
    const BorderCurves& curves,
    std::vector<BorderRing>& strips) {
    const auto angle = [&](const BorderPoint& point, std::uint32_t curve) {
        return nearest_degrees(curves.all()[curve], point);
    };
    for (std::size_t i = 0; i + 1 < border.size(); ++i) {
        const std::uint32_t curve = border[i].curve;
        if (curve == no_curve || (i > 0 && border[i - 1].curve == curve))
            continue;
        // What is left of the border lies within the curve where it goes on towards larger angles.
        const bool is_within = turned(angle(border[i], curve), angle(border[i + 1], curve)) > 0;
        for (BorderRing& strip : strips)
            for (BorderPoint& point : strip)
                if (point.curve == curve)
                    point.curve = is_within ? curves.smaller(curve) : curves.larger(curve);
    }
}

std::vector<BorderRing>
seam_strips(std::span<const BorderPoint> border, const std::vector<BorderRing>& neighbour) {
    const std::vector<BorderEnd> ends = ends_of(border, neighbour);
    std::vector<BorderRing> strips;
    for (std::size_t first = 0; first + 1 < border.size();) {
        const std::size_t last = end_of_straight(border, first);
        std::vector<BorderRing> along = strips_along(border[first], border[last], neighbour);
        for (const BorderEnd& end : ends) {
            const bool begins_nearer =
                distance(end.point, border[first]) <= distance(end.point, border[last]);
            along = begins_nearer ? end.cut(along, border[first], border[last])
                                  : end.cut(along, border[last], border[first]);
        }
        std::ranges::move(along, std::back_inserter(strips));
        first = last;
    }
    return strips;
}

} // namespace vera
