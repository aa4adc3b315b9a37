// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/border_ring.h"

#include "vera/drawing/elliptic_arc.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace vera {

namespace {

/// The ring, from a place on at which an arc may end, as the sides of an outline.
class RingMaker {
public:
    RingMaker(const BorderRing& ring, std::span<const DrawingEllipse> curves)
        : ring_(ring)
        , curves_(curves) {
        while (first_ < ring.size() && goes_on_through(first_))
            ++first_;
    }

    void add_to(FilledOutline& outline) const {
        std::vector<DrawingPoint> points;
        std::vector<DrawingArc> arcs;
        if (first_ == ring_.size())
            add_whole_turn(points, arcs);
        else
            add_sides(points, arcs);
        if (points.empty())
            return;
        if (!arcs.empty()) {
            outline.arcs.resize(outline.rings.size());
            outline.arcs.push_back(std::move(arcs));
        }
        outline.rings.push_back(std::move(points));
    }

private:
    const BorderPoint& point(std::size_t i) const { return ring_[i % ring_.size()]; }

    /// Whether the side before the point and that behind it are one arc.
    bool goes_on_through(std::size_t i) const {
        return point(i).curve != no_curve && !point(i).is_node
            && point(i + ring_.size() - 1).curve == point(i).curve;
    }

    /// By which angle the sides of one curve lead along it.
    double sweep(std::size_t begin, std::size_t end) const {
        const DrawingEllipse& ellipse = curves_[point(begin).curve];
        double sum = 0;
        double last = nearest_degrees(ellipse, point(begin));
        for (std::size_t i = begin + 1; i <= end; ++i) {
            const double next = nearest_degrees(ellipse, point(i));
            sum += turned(last, next);
            last = next;
        }
        return sum;
    }

    void add_whole_turn(std::vector<DrawingPoint>& points, std::vector<DrawingArc>& arcs) const {
        const DrawingEllipse& ellipse = curves_[ring_.front().curve];
        const double sum = sweep(0, ring_.size());
        if (std::abs(sum) < 180)
            return;
        // From the same point in both directions, and for all that have this border.
        points.push_back(point_at(ellipse, 0));
        arcs.push_back({0, ellipse, sum > 0 ? 0.0 : 360.0, sum > 0 ? 360.0 : 0.0});
    }

    std::size_t count_sides() const {
        std::size_t count = 0;
        for (std::size_t i = 0; i < ring_.size(); ++i)
            count += goes_on_through(i) ? 0 : 1;
        return count;
    }

    void add_sides(std::vector<DrawingPoint>& points, std::vector<DrawingArc>& arcs) const {
        points.reserve(count_sides());
        for (std::size_t i = first_, end = 0; i < first_ + ring_.size(); i = end) {
            end = i + 1;
            const std::uint32_t curve = point(i).curve;
            points.push_back(on_sides(i));
            if (curve == no_curve)
                continue;
            while (end < first_ + ring_.size() && goes_on_through(end))
                ++end;
            const DrawingEllipse& ellipse = curves_[curve];
            const double begin = nearest_degrees(ellipse, point(i));
            const double most = 360;
            arcs.push_back(
                {points.size() - 1,
                 ellipse,
                 begin,
                 begin + std::clamp(sweep(i, end), -most, most)});
        }
    }

    /// Where the point is to be: where a chord was cut, on the arc.
    DrawingPoint on_sides(std::size_t i) const {
        constexpr double hardly = 1e-3; // pixels: moved there already
        for (const std::size_t side : {i, i + ring_.size() - 1})
            if (const std::uint32_t curve = point(side).curve; curve != no_curve) {
                const DrawingPoint on =
                    point_at(curves_[curve], nearest_degrees(curves_[curve], point(i)));
                if (distance(on, point(i)) > hardly)
                    return on;
            }
        return point(i);
    }

    const BorderRing& ring_;
    std::span<const DrawingEllipse> curves_;
    std::size_t first_ = 0;
};

} // namespace

BorderCurves::BorderCurves(std::span<const DrawingEllipse> curves)
    : count_(static_cast<std::uint32_t>(curves.size())) {
    constexpr double trace = 0.05; // pixels: several roundings
    for (const double by : {0.0, -trace, trace})
        for (const DrawingEllipse& curve : curves) {
            const auto longer = [&](DrawingPoint axis) {
                const double factor = std::max(0.1, 1 + by / distance(axis, {}));
                return DrawingPoint{factor * axis.x, factor * axis.y};
            };
            curves_.push_back({curve.center, longer(curve.major), longer(curve.minor)});
        }
}

void add_ring(
    const BorderRing& ring, std::span<const DrawingEllipse> curves, FilledOutline& outline) {
    if (!ring.empty())
        RingMaker(ring, curves).add_to(outline);
}

} // namespace vera
