// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/turned.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vera {

namespace {

using Point = ContourPiece::Point;

/// Whether the line between them is on the axis.
bool is_on_axis(Point a, Point b) {
    return a.r == 0 && b.r == 0;
}

double distance(Point a, Point b) {
    return std::sqrt((b.r - a.r) * (b.r - a.r) + (b.h - a.h) * (b.h - a.h));
}

/// Twice the area between the profile and the axis, positive where the profile's outer side is
/// outside of it.
double signed_area(std::span<const Point> profile) {
    const Point first = profile.front();
    const Point last = profile.back();
    double area = last.r * last.h - first.r * first.h; // straight to the axis, and back from it
    for (std::size_t i = 0; i + 1 < profile.size(); ++i)
        area += profile[i].r * profile[i + 1].h - profile[i + 1].r * profile[i].h;
    return area;
}

/// The unit direction in which a smooth profile passes its point i: that from the point before it
/// to the one behind it. At a corner there is none of the one or the other. On the axis the surface
/// is level.
Point direction_at(std::span<const Point> profile, std::size_t i) {
    const bool begins = i == 0 || profile[i - 1] == profile[i];
    const bool ends = i + 1 == profile.size() || profile[i] == profile[i + 1];
    const Point from = begins ? profile[i] : profile[i - 1];
    const Point to = ends ? profile[i] : profile[i + 1];
    const double length = distance(from, to);
    if (length == 0)
        return {};
    if (profile[i].r == 0 && begins != ends)
        return {begins ? 1.0 : -1.0, 0};
    return {(to.r - from.r) / length, (to.h - from.h) / length};
}

ContourPiece smooth_piece(std::span<const Point> profile, std::size_t i) {
    const Point from = profile[i];
    const Point to = profile[i + 1];
    const double reach = distance(from, to) / 3;
    const Point first = direction_at(profile, i);
    const Point second = direction_at(profile, i + 1);
    // The curve lies within the hull of its control points: it does not cross the axis.
    return {
        .kind = ContourPiece::Kind::cubic,
        .control =
            {{{std::max(0.0, from.r + reach * first.r), from.h + reach * first.h},
              {std::max(0.0, to.r - reach * second.r), to.h - reach * second.h}}},
        .end = to};
}

} // namespace

RotationalShape turned_shape(std::span<const ContourPiece::Point> profile, ProfileForm form) {
    std::vector<Point> points(profile.begin(), profile.end());
    RotationalShape shape;
    shape.axis = {0, 1, 0};
    if (points.empty())
        return shape;
    if (signed_area(points) < 0)
        std::reverse(points.begin(), points.end());
    // From the first piece to the last one that have an area.
    while (points.size() > 1 && is_on_axis(points[0], points[1]))
        points.erase(points.begin());
    while (points.size() > 1 && is_on_axis(points[points.size() - 2], points.back()))
        points.pop_back();
    shape.start = points.front();
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        if (points[i] != points[i + 1])
            shape.contour.push_back(
                form == ProfileForm::smooth && !is_on_axis(points[i], points[i + 1])
                    ? smooth_piece(points, i)
                    : ContourPiece{.end = points[i + 1]});
    return shape;
}

} // namespace vera
