// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/depth_plane.h"

namespace vera {

DepthPlane depth_plane(const std::array<ScreenVertex, 3>& corners) {
    const ScreenStep one = step(corners[0].point, corners[1].point);
    const ScreenStep other = step(corners[0].point, corners[2].point);
    const std::int64_t rise_one = corners[1].nearness - corners[0].nearness;
    const std::int64_t rise_other = corners[2].nearness - corners[0].nearness;
    return {
        corners[0].point,
        corners[0].nearness,
        rise_one * other.y - rise_other * one.y,
        rise_other * one.x - rise_one * other.x,
        cross(one, other)};
}

Int128 nearness_difference(const DepthPlane& a, const DepthPlane& b, ScreenPoint point) {
    const auto scaled = [&](const DepthPlane& plane) {
        const ScreenStep way = step(plane.at, point);
        return Int128{plane.area} * plane.nearness + Int128{plane.along_x} * way.x
            + Int128{plane.along_y} * way.y;
    };
    return scaled(a) * b.area - scaled(b) * a.area;
}

Int128 nearness_growth(const DepthPlane& a, const DepthPlane& b, ScreenStep along) {
    const auto scaled = [&](const DepthPlane& plane) {
        return Int128{plane.along_x} * along.x + Int128{plane.along_y} * along.y;
    };
    return scaled(a) * b.area - scaled(b) * a.area;
}

PlaneComparison::PlaneComparison(
    const DepthPlane& a, const DepthPlane& b, ScreenPoint begin, ScreenPoint end)
    : at_begin(nearness_difference(a, b, begin))
    , at_end(nearness_difference(a, b, end)) {
    if (at_begin == 0 && at_end == 0) {
        const ScreenStep whole = step(begin, end);
        to_left = sign(nearness_growth(a, b, {-whole.y, whole.x}));
    }
}

int PlaneComparison::at(SegmentPlace place) const {
    if (sign(at_begin) == sign(at_end))
        return sign(at_begin);
    // at_begin (1 - place) + at_end place
    return sign_of_difference(
        at_begin, place.denominator - place.numerator, -at_end, place.numerator);
}

bool PlaneComparison::keeps_order(SegmentPlace first, SegmentPlace last) const {
    return sign(at_begin) * sign(at_end) >= 0 || at(first) * at(last) >= 0;
}

int PlaneComparison::beside(SegmentPlace first, SegmentPlace last, bool on_left) const {
    if (at_begin == 0 && at_end == 0)
        return on_left ? to_left : -to_left;
    const int at_first = at(first);
    const int at_last = at(last);
    if (at_first * at_last >= 0)
        return at_first != 0 ? at_first : at_last;
    const double middle = 0.5 * (first.value() + last.value());
    const double value =
        static_cast<double>(at_begin) * (1 - middle) + static_cast<double>(at_end) * middle;
    return value > 0 ? 1 : -1;
}

} // namespace vera
