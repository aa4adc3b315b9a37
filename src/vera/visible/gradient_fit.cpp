// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/gradient_fit.h"

#include "vera/base/check.h"
#include "vera/drawing/gradient.h"
#include "vera/visible/color_profile.h"
#include "vera/visible/drawn_color.h"
#include "vera/visible/gradient_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace vera {

namespace {

/// The gradient of that shape with the stops that fit best: more and more of them,
/// until the error is within the tolerance or more do not help.
FittedPaint with_stops(Gradient gradient, std::span<const ColorSample> samples, double tolerance) {
    constexpr std::size_t most_stops = 16;
    constexpr int patience = 4;

    ColorProfile profile(gradient, samples, tolerance);
    FittedPaint best;
    best.error = 2; // more than any
    if (!profile.has_extent())
        return best;
    for (int in_vain = 0; in_vain < patience; ++in_vain) {
        std::vector<GradientStop> stops = profile.stops();
        const double error = profile.largest_error(stops);
        const bool is_full = stops.size() >= most_stops;
        if (error < 0.9 * best.error)
            in_vain = 0;
        if (error < best.error) {
            gradient.stops = std::move(stops);
            best.error = error;
        }
        if (error <= tolerance || is_full || !profile.add_knot())
            break;
    }
    if (!gradient.stops.empty())
        best.gradient = std::move(gradient);
    return best;
}

FittedPaint
linear_fit_along(DrawingPoint along, std::span<const ColorSample> samples, double tolerance) {
    const auto way = [&](DrawingPoint point) { return point.x * along.x + point.y * along.y; };
    const auto [first, last] = std::ranges::minmax(
        samples, {}, [&](const ColorSample& sample) { return way(sample.point); });
    const double length = way(last.point) - way(first.point);
    if (!(length > 0))
        return flat_fit(samples);
    Gradient gradient;
    gradient.start = first.point;
    gradient.axis = {length * along.x, length * along.y};
    return with_stops(gradient, samples, tolerance);
}

} // namespace

Color color_at(const FittedPaint& paint, DrawingPoint point) {
    if (paint.gradient)
        return color_at(*paint.gradient, point);
    return {paint.color.r / 255.0, paint.color.g / 255.0, paint.color.b / 255.0};
}

double error_of(const FittedPaint& paint, const ColorSample& sample) {
    return std::max(
        0.0, largest_difference(color_at(paint, sample.point), sample.color) - sample.slack);
}

FittedPaint flat_fit(std::span<const ColorSample> samples) {
    VERA_CHECK(!samples.empty());
    Color least = samples.front().color;
    Color most = least;
    for (const ColorSample& sample : samples) {
        least = min(least, sample.color);
        most = max(most, sample.color);
    }
    FittedPaint paint;
    paint.color = drawn_color(0.5 * (least + most));
    for (const ColorSample& sample : samples)
        paint.error = std::max(paint.error, error_of(paint, sample));
    return paint;
}

FittedPaint linear_fit(std::span<const ColorSample> samples, double tolerance) {
    FittedPaint best =
        linear_fit_along(direction_of_planes(samples, tolerance), samples, tolerance);
    const auto try_along = [&](DrawingPoint along) {
        if (best.error <= tolerance)
            return;
        if (FittedPaint other = linear_fit_along(along, samples, tolerance);
            other.error < best.error)
            best = std::move(other);
    };
    if (best.error > tolerance && best.gradient)
        try_along(turned(*best.gradient, samples, tolerance));
    if (best.error > tolerance)
        try_along(direction_of_slopes(samples, tolerance));
    return best;
}

std::optional<FittedPaint> radial_fit(std::span<const ColorSample> samples, double tolerance) {
    const std::optional<Ellipses> ellipses = level_ellipses(samples, tolerance);
    if (!ellipses)
        return std::nullopt;
    const DrawingPoint along = main_direction(ellipses->xx, ellipses->xy, ellipses->yy);
    const DrawingPoint across = {-along.y, along.x};
    const auto value = [&](double x, double y) {
        return ellipses->xx * x * x + 2 * ellipses->xy * x * y + ellipses->yy * y * y;
    };
    double largest = 0;
    for (const ColorSample& sample : samples)
        largest = std::max(
            largest,
            value(sample.point.x - ellipses->center.x, sample.point.y - ellipses->center.y));
    const double half = std::sqrt(largest / value(along.x, along.y));
    const double other_half = std::sqrt(largest / value(across.x, across.y));
    Gradient gradient;
    gradient.shape = Gradient::Shape::radial;
    gradient.start = ellipses->center;
    gradient.axis = {half * along.x, half * along.y};
    gradient.other_axis = {other_half * across.x, other_half * across.y};
    if (!(half > 0 && std::isfinite(other_half)))
        return std::nullopt;
    return with_stops(gradient, samples, tolerance);
}

FittedPaint best_fit(std::span<const ColorSample> samples, double tolerance) {
    FittedPaint best = flat_fit(samples);
    if (best.error <= tolerance)
        return best;
    if (FittedPaint linear = linear_fit(samples, tolerance); linear.error < best.error)
        best = std::move(linear);
    if (best.error <= tolerance)
        return best;
    if (auto radial = radial_fit(samples, tolerance); radial && radial->error < best.error)
        best = std::move(*radial);
    return best;
}

} // namespace vera
