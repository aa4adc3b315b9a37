// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/seams.h"

#include "vera/drawing/elliptic_arc.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <tuple>
#include <utility>

namespace vera::detail {

namespace {

struct Direction {
    double x = 0;
    double y = 0;
};

Direction from_to(SnappedPoint from, SnappedPoint to) {
    return {static_cast<double>(to.x - from.x), static_cast<double>(to.y - from.y)};
}

double dot(Direction a, Direction b) {
    return a.x * b.x + a.y * b.y;
}

/// Not std::hypot, which differs between machines.
double length(Direction direction) {
    return std::sqrt(dot(direction, direction));
}

void append(std::vector<SnappedPoint>& points, const std::vector<SnappedPoint>& others) {
    points.insert(points.end(), others.begin() + 1, others.end());
}

/// Finds the points of a border.
class Border {
public:
    explicit Border(std::span<const SnappedPath> rings)
        : rings_(rings) {
        for (std::size_t ring = 0; ring < rings.size(); ++ring)
            for (std::size_t i = 0; i < rings[ring].points.size(); ++i)
                places_.emplace_back(rings[ring].points[i].x, rings[ring].points[i].y, ring, i);
        std::ranges::sort(places_);
    }

    /// How the border leaves the point, other than in that direction; nothing when it has no such
    /// point.
    std::optional<Direction> other_way(SnappedPoint point, Direction direction) const {
        const auto place = std::ranges::lower_bound(
            places_, Place(point.x, point.y, std::size_t{0}, std::size_t{0}));
        if (place == places_.end() || std::get<0>(*place) != point.x
            || std::get<1>(*place) != point.y)
            return std::nullopt;
        const SnappedPath& ring = rings_[std::get<2>(*place)];
        const std::size_t i = std::get<3>(*place);
        const std::size_t count = ring.points.size();
        const std::size_t before = (i + count - 1) % count;
        const Direction next =
            begin_of(ring, i).value_or(from_to(point, ring.points[(i + 1) % count]));
        const Direction previous =
            end_of(ring, before).value_or(from_to(point, ring.points[before]));
        const double next_cosine = dot(next, direction) / length(next);
        return next_cosine > dot(previous, direction) / length(previous) ? previous : next;
    }

private:
    static const DrawingArc* arc_at(const SnappedPath& ring, std::size_t segment) {
        const auto found = std::ranges::lower_bound(ring.arcs, segment, {}, &DrawingArc::segment);
        return found == ring.arcs.end() || found->segment != segment ? nullptr : &*found;
    }

    static Direction tangent(const DrawingArc& arc, double degrees, bool is_back) {
        const DrawingPoint way = tangent_at(arc.ellipse, degrees);
        const bool is_against = (arc.end_degrees < arc.begin_degrees) != is_back;
        return is_against ? Direction{-way.x, -way.y} : Direction{way.x, way.y};
    }

    /// The directions into a segment from its beginning and its end, if it is an arc.
    static std::optional<Direction> begin_of(const SnappedPath& ring, std::size_t segment) {
        const DrawingArc* arc = arc_at(ring, segment);
        return arc ? std::optional(tangent(*arc, arc->begin_degrees, false)) : std::nullopt;
    }

    static std::optional<Direction> end_of(const SnappedPath& ring, std::size_t segment) {
        const DrawingArc* arc = arc_at(ring, segment);
        return arc ? std::optional(tangent(*arc, arc->end_degrees, true)) : std::nullopt;
    }

    using Place = std::tuple<std::int64_t, std::int64_t, std::size_t, std::size_t>;

    std::span<const SnappedPath> rings_;
    std::vector<Place> places_; ///< x, y, ring, and number in the ring
};

/// How far the end is to be drawn back so that a corner of the line does not stick out.
double excess(
    const std::vector<SnappedPoint>& points,
    const Border& border,
    const PassedPoints& passed,
    double half_width) {
    const SnappedPoint end = points.back();
    const Direction inward = from_to(end, points[points.size() - 2]);
    const std::optional<Direction> other = border.other_way(end, inward);
    if (!other)
        return 0;
    const double most = passed.contains(end) ? half_width / 2 : half_width;
    const double along = std::abs(dot(inward, *other));
    const double across = std::abs(inward.x * other->y - inward.y * other->x);
    return along < across ? std::min(most, half_width * (along / across)) : most;
}

/// Takes that length off the end; less than two points are left when there is not as much.
void shorten(std::vector<SnappedPoint>& points, double excess) {
    while (points.size() > 1 && excess > 0) {
        const SnappedPoint end = points.back();
        points.pop_back();
        const Direction back = from_to(end, points.back());
        const double part = excess / length(back);
        excess -= length(back);
        if (part >= 1)
            continue;
        const SnappedPoint shortened = {
            end.x + std::llround(part * back.x), end.y + std::llround(part * back.y)};
        if (shortened != points.back())
            points.push_back(shortened);
    }
}

} // namespace

std::vector<SnappedPath> joined_seams(const FilledOutline& fill, const Lattice& lattice) {
    std::vector<SnappedPath> seams;
    for (const auto& seam : fill.seams) {
        const std::vector<SnappedPoint> points = snapped_points(seam, lattice);
        if (points.size() < 2)
            continue;
        if (!seams.empty() && seams.back().points.back() == points.front())
            append(seams.back().points, points);
        else
            seams.push_back({points, false});
    }
    if (seams.size() > 1 && seams.back().points.back() == seams.front().points.front()) {
        append(seams.back().points, seams.front().points);
        seams.erase(seams.begin());
    }
    for (SnappedPath& seam : seams)
        if (seam.points.size() > 3 && seam.points.back() == seam.points.front()) {
            seam.points.pop_back();
            seam.closed = true;
        }
    return seams;
}

void PassedPoints::add(std::span<const SnappedPath> seams) {
    for (const SnappedPath& seam : seams) {
        const std::span<const SnappedPoint> all = seam.points;
        for (const SnappedPoint point : seam.closed ? all : all.subspan(1, all.size() - 2))
            y_of_x_[point.x].insert(point.y);
    }
}

bool PassedPoints::contains(SnappedPoint point) const {
    const auto column = y_of_x_.find(point.x);
    return column != y_of_x_.end() && column->second.contains(point.y);
}

void draw_ends_back(
    std::vector<SnappedPath>& seams,
    std::span<const SnappedPath> rings,
    const PassedPoints& passed,
    double width) {
    if (std::ranges::all_of(seams, &SnappedPath::closed))
        return;
    const Border border(rings);
    for (SnappedPath& seam : seams) {
        if (seam.closed)
            continue;
        const double last_excess = excess(seam.points, border, passed, width / 2);
        std::ranges::reverse(seam.points);
        const double first_excess = excess(seam.points, border, passed, width / 2);
        shorten(seam.points, first_excess);
        std::ranges::reverse(seam.points);
        shorten(seam.points, last_excess);
    }
    std::erase_if(seams, [](const SnappedPath& seam) { return seam.points.size() < 2; });
}

} // namespace vera::detail
