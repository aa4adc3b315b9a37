// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/color_samples.h"

#include <algorithm>
#include <cmath>

namespace vera {

ColorSample color_sample(DrawingPoint point, const ColorField& field, double within) {
    return color_sample({point, field(point)}, field, within);
}

ColorSample color_sample(const PointColor& at, const ColorField& field, double within) {
    const auto [point, color] = at;
    // Of three directions, two are never along a level, and one leads in from any border.
    const double side = std::sqrt(0.75);
    const DrawingPoint ways[] = {{1, 0}, {-0.5, side}, {-0.5, -side}};
    ColorSample sample = {point, color};
    for (const DrawingPoint way : ways) {
        const Color there = field({point.x + within * way.x, point.y + within * way.y});
        const Color change = there - sample.color;
        sample.slack = std::max(sample.slack, largest_difference(there, sample.color));
        const double part = 2 / (3 * within);
        sample.slope_x += part * way.x * change;
        sample.slope_y += part * way.y * change;
    }
    return sample;
}

std::vector<ColorSample>
color_samples(std::span<const DrawingPoint> points, const ColorField& field, double within) {
    std::vector<ColorSample> samples;
    samples.reserve(points.size());
    for (const DrawingPoint point : points)
        samples.push_back(color_sample(point, field, within));
    return samples;
}

double largest_difference(Color a, Color b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

double weight_of(const ColorSample& sample, double tolerance) {
    const double relative = tolerance / (tolerance + sample.slack);
    return relative * relative;
}

Moments moments_of(std::span<const ColorSample> samples, double tolerance) {
    Moments moments;
    double sum = 0;
    for (const ColorSample& sample : samples)
        sum += weight_of(sample, tolerance);
    for (const ColorSample& sample : samples) {
        const double part = weight_of(sample, tolerance) / sum;
        moments.middle.x += part * sample.point.x;
        moments.middle.y += part * sample.point.y;
    }
    for (const ColorSample& sample : samples) {
        const double part = weight_of(sample, tolerance) / sum;
        const double x = sample.point.x - moments.middle.x;
        const double y = sample.point.y - moments.middle.y;
        moments.xx += part * x * x;
        moments.xy += part * x * y;
        moments.yy += part * y * y;
    }
    return moments;
}

} // namespace vera
