// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/elliptic_arc.h"

#include "vera/math/elementary.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vera {

namespace {

constexpr double degrees_per_radian = 57.295779513082320877;

double length(DrawingPoint a) {
    return std::sqrt(a.x * a.x + a.y * a.y);
}

/// The cosine and sine of the point's angle that is nearest in the first quarter of the ellipse
/// with these axes, a >= b (Eberly, Distance from a point to an ellipse, an ellipsoid, or a
/// hyperellipsoid, 2013): a root of a function.
DrawingPoint nearest_in_quarter(double a, double b, DrawingPoint point) {
    if (point.y == 0) {
        const double c = std::min(1.0, a > b ? a * point.x / (a * a - b * b) : 1);
        return {c, std::sqrt(1 - c * c)};
    }
    const double ratio = (a / b) * (a / b);
    const double x = point.x / a;
    const double y = point.y / b;
    // The function of t + 1 is convex and falls, and is positive here: Newton's method never comes
    // too far.
    double t1 = y;
    for (int i = 0; i < 200; ++i) {
        const double c = ratio * x / (t1 + (ratio - 1));
        const double s = y / t1;
        const double off = c * c + s * s - 1;
        const double next = t1 + off / (2 * (c * c / (t1 + (ratio - 1)) + s * s / t1));
        if (!(off > 0 && next > t1))
            break;
        t1 = next;
    }
    return {ratio * x / (t1 + (ratio - 1)), y / t1};
}

} // namespace

double direction_degrees(DrawingPoint direction) {
    if (direction.x == 0 && direction.y == 0)
        return 0;
    // Half of a direction's angle is that of its sum with the x axis, which must not be opposite.
    const bool is_backward = direction.x < 0;
    const double scale =
        (is_backward ? -1 : 1) / std::max(std::abs(direction.x), std::abs(direction.y));
    DrawingPoint half = {scale * direction.x, scale * direction.y};
    constexpr int halvings = 5;
    for (int i = 0; i < halvings; ++i)
        half.x += length(half);
    const double t = half.y / half.x; // the tangent of 90 / 32 degrees at most
    const double s = t * t;
    const double radians = t * (1 - s * (1.0 / 3 - s * (1.0 / 5 - s * (1.0 / 7 - s / 9))));
    const double degrees = radians * degrees_per_radian * (1 << halvings);
    if (!is_backward)
        return degrees;
    return direction.y < 0 ? degrees - 180 : degrees + 180;
}

DrawingPoint point_at(const DrawingEllipse& ellipse, double degrees) {
    const double c = cos_degrees(degrees);
    const double s = sin_degrees(degrees);
    return {
        ellipse.center.x + c * ellipse.major.x + s * ellipse.minor.x,
        ellipse.center.y + c * ellipse.major.y + s * ellipse.minor.y};
}

DrawingPoint tangent_at(const DrawingEllipse& ellipse, double degrees) {
    const double c = cos_degrees(degrees);
    const double s = sin_degrees(degrees);
    return {c * ellipse.minor.x - s * ellipse.major.x, c * ellipse.minor.y - s * ellipse.major.y};
}

double nearest_degrees(const DrawingEllipse& ellipse, DrawingPoint point) {
    const double a = length(ellipse.major);
    const double b = length(ellipse.minor);
    const double dx = point.x - ellipse.center.x;
    const double dy = point.y - ellipse.center.y;
    const double along = (dx * ellipse.major.x + dy * ellipse.major.y) / a;
    const double across = (dx * ellipse.minor.x + dy * ellipse.minor.y) / b;
    const DrawingPoint found = nearest_in_quarter(a, b, {std::abs(along), std::abs(across)});
    return direction_degrees({along < 0 ? -found.x : found.x, across < 0 ? -found.y : found.y});
}

double distance(DrawingPoint a, DrawingPoint b) {
    return length({a.x - b.x, a.y - b.y});
}

double turned(double from, double to) {
    constexpr double whole_turn = 360;
    const double by = to - from;
    return by - whole_turn * std::floor((by + whole_turn / 2) / whole_turn);
}

BezierControls bezier_controls(const DrawingEllipse& ellipse, double begin, double end) {
    const double quarter = (end - begin) / 4;
    const double reach = 4.0 / 3 * sin_degrees(quarter) / cos_degrees(quarter);
    const auto beside = [&](double degrees, double step) {
        const DrawingPoint at = point_at(ellipse, degrees);
        const DrawingPoint along = tangent_at(ellipse, degrees);
        return DrawingPoint{at.x + step * along.x, at.y + step * along.y};
    };
    return {beside(begin, reach), beside(end, -reach)};
}

DrawingPoint quadratic_control(const DrawingArc& arc) {
    const double half = (arc.end_degrees - arc.begin_degrees) / 2;
    const double reach = sin_degrees(half) / cos_degrees(half);
    const DrawingPoint at = point_at(arc.ellipse, arc.begin_degrees);
    const DrawingPoint along = tangent_at(arc.ellipse, arc.begin_degrees);
    return {at.x + reach * along.x, at.y + reach * along.y};
}

double quadratic_error(const DrawingArc& arc) {
    const double half = std::abs(arc.end_degrees - arc.begin_degrees) / 2;
    if (half >= 90)
        return std::numeric_limits<double>::infinity();
    // Of the unit circle, in the middle, where the curve is half way from its chord to its control
    // point.
    const double cosine = cos_degrees(half);
    return length(arc.ellipse.major) * (1 - cosine) * (1 - cosine) / (2 * cosine);
}

int bezier_parts(const DrawingArc& arc, double error) {
    const double whole = std::abs(arc.end_degrees - arc.begin_degrees);
    // The error grows with the sixth power of the angle.
    const auto error_of = [&](int parts) {
        const double of_90 = whole / parts / 90;
        return 2.8e-4 * length(arc.ellipse.major) * of_90 * of_90 * of_90 * of_90 * of_90 * of_90;
    };
    int parts = std::max(1, static_cast<int>(std::ceil(whole / 90 - 1e-9)));
    while (error_of(parts) > error)
        ++parts;
    return parts;
}

} // namespace vera
