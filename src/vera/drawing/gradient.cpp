// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/gradient.h"

#include "vera/base/check.h"

#include <algorithm>
#include <cmath>

namespace vera {

namespace {

Color as_color(DrawingColor color) {
    return {color.r / 255.0, color.g / 255.0, color.b / 255.0};
}

} // namespace

double gradient_offset(const Gradient& gradient, DrawingPoint point) {
    const double x = point.x - gradient.start.x;
    const double y = point.y - gradient.start.y;
    const DrawingPoint a = gradient.axis;
    if (gradient.shape == Gradient::Shape::linear)
        return (x * a.x + y * a.y) / (a.x * a.x + a.y * a.y);
    const DrawingPoint b = gradient.other_axis;
    const double determinant = a.x * b.y - a.y * b.x;
    const double along_a = (x * b.y - y * b.x) / determinant;
    const double along_b = (a.x * y - a.y * x) / determinant;
    return std::sqrt(along_a * along_a + along_b * along_b);
}

Color color_at(const Gradient& gradient, DrawingPoint point) {
    VERA_CHECK(!gradient.stops.empty());
    const double offset = gradient_offset(gradient, point);
    const auto after = std::upper_bound(
        gradient.stops.begin(),
        gradient.stops.end(),
        offset,
        [](double value, const GradientStop& stop) { return value < stop.offset; });
    if (after == gradient.stops.begin())
        return as_color(gradient.stops.front().color);
    if (after == gradient.stops.end())
        return as_color(gradient.stops.back().color);
    const GradientStop& before = *(after - 1);
    const double part = (offset - before.offset) / (after->offset - before.offset);
    const Color from = as_color(before.color);
    return from + part * (as_color(after->color) - from);
}

} // namespace vera
