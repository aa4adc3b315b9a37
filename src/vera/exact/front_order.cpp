// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/front_order.h"

#include <algorithm>
#include <cstddef>

namespace vera {

namespace {

/// What is no farther apart anywhere lies in one plane.
double coincident_distance(const NearnessSlope& a, const NearnessSlope& b) {
    return 0.75 * (a.per_step() + b.per_step()) + 2;
}

/// The convex area that two triangles have in common.
class Overlap {
public:
    explicit Overlap(const std::array<ScreenVertex, 3>& corners) {
        for (const ScreenVertex& corner : corners)
            add({static_cast<double>(corner.point.x), static_cast<double>(corner.point.y)});
    }

    /// Leaves what lies on the left of the way from a to b (Sutherland and Hodgman 1974).
    void cut(ScreenPoint a, ScreenPoint b) {
        const std::array<NearnessPlace, most> from = places_;
        const std::size_t count = count_;
        count_ = 0;
        const ScreenStep way = step(a, b);
        const auto side = [&](NearnessPlace place) {
            return static_cast<double>(way.x) * (place.y - a.y)
                - static_cast<double>(way.y) * (place.x - a.x);
        };
        for (std::size_t i = 0; i < count; ++i) {
            const NearnessPlace& here = from[i];
            const NearnessPlace& next = from[i + 1 == count ? 0 : i + 1];
            const double side_here = side(here);
            const double side_next = side(next);
            if (side_here >= 0)
                add(here);
            if ((side_here > 0 && side_next < 0) || (side_here < 0 && side_next > 0)) {
                const double part = side_here / (side_here - side_next);
                add({here.x + part * (next.x - here.x), here.y + part * (next.y - here.y)});
            }
        }
    }

    const NearnessPlace* begin() const { return places_.data(); }

    const NearnessPlace* end() const { return places_.data() + count_; }

private:
    // Each cut adds one corner at most; rounding may add another.
    static constexpr std::size_t most = 12;

    void add(NearnessPlace place) {
        if (count_ < most)
            places_[count_++] = place;
    }

    std::array<NearnessPlace, most> places_;
    std::size_t count_ = 0;
};

} // namespace

NearnessSlope nearness_slope(const DepthPlane& plane) {
    const auto area = static_cast<double>(plane.area);
    return {
        plane.at,
        static_cast<double>(plane.nearness),
        static_cast<double>(plane.along_x) / area,
        static_cast<double>(plane.along_y) / area};
}

FrontOrder order_along(
    const NearnessSlope& a, const NearnessSlope& b, const std::array<NearnessPlace, 2>& places) {
    const double sure = sure_margin(a) + sure_margin(b);
    bool first = false;
    bool second = false;
    for (const NearnessPlace& place : places) {
        const double difference = a.at(place) - b.at(place);
        first = first || difference > sure;
        second = second || difference < -sure;
    }
    if (first == second)
        return first ? FrontOrder::penetrating : FrontOrder::unknown;
    return first ? FrontOrder::first : FrontOrder::second;
}

FrontOrder order_in_overlap(const FrontFace& a, const FrontFace& b) {
    Overlap overlap(a.corners);
    for (std::size_t i = 0; i < 3; ++i)
        overlap.cut(b.corners[i].point, b.corners[(i + 1) % 3].point);
    double a_before_b = 0;
    double b_before_a = 0;
    for (const NearnessPlace& place : overlap) {
        const double difference = a.slope.at(place) - b.slope.at(place);
        a_before_b = std::max(a_before_b, difference);
        b_before_a = std::max(b_before_a, -difference);
    }
    const double sure = sure_margin(a.slope) + sure_margin(b.slope);
    if (a_before_b > sure && b_before_a > sure)
        return FrontOrder::penetrating;
    if (std::max(a_before_b, b_before_a) <= coincident_distance(a.slope, b.slope))
        return FrontOrder::coincident;
    return a_before_b >= b_before_a ? FrontOrder::first : FrontOrder::second;
}

} // namespace vera
