// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/paints.h"

#include "vera/base/check.h"
#include "vera/base/random.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

namespace vera::detail {

namespace {

/// Digits behind the point of offsets, and of numbers of a pattern's matrix.
constexpr int offset_digits = 4;
constexpr int matrix_digits = 5;

/// From one stop's colour to the next one's.
std::string interpolation(const GradientStop& from, const GradientStop& to) {
    return fmt::format(
        "<</FunctionType 2/Domain[0 1]/C0[{}]/C1[{}]/N 1>>",
        components(from.color),
        components(to.color));
}

/// The colour as a function of the offset.
std::string color_function(std::vector<GradientStop> stops) {
    // Functions have the domain from 0 to 1, all of it.
    if (stops.front().offset > 0)
        stops.insert(stops.begin(), {0, stops.front().color});
    if (stops.back().offset < 1)
        stops.push_back({1, stops.back().color});
    if (stops.size() == 2)
        return interpolation(stops[0], stops[1]);
    std::string functions;
    std::string bounds;
    std::string encode;
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
        functions += interpolation(stops[i], stops[i + 1]);
        encode += i == 0 ? "0 1" : " 0 1";
        if (i > 0)
            bounds.append(i == 1 ? "" : " ").append(decimal(stops[i].offset, offset_digits));
    }
    return fmt::format(
        "<</FunctionType 3/Domain[0 1]/Functions[{}]/Bounds[{}]/Encode[{}]>>",
        functions,
        bounds,
        encode);
}

} // namespace

std::size_t Gradients::Hash::operator()(const Gradient* gradient) const {
    std::uint64_t hash = 0;
    const auto mix = [&](std::uint64_t value) { hash = scrambled_bits(hash ^ value); };
    const auto mix_point = [&](DrawingPoint point) {
        // Both zeros are equal.
        mix(std::bit_cast<std::uint64_t>(point.x + 0.0));
        mix(std::bit_cast<std::uint64_t>(point.y + 0.0));
    };
    mix_point(gradient->start);
    mix_point(gradient->axis);
    for (const GradientStop& stop : gradient->stops)
        mix(static_cast<std::uint64_t>(stop.color.r) << 16U
            | static_cast<std::uint64_t>(stop.color.g) << 8U | stop.color.b);
    return hash;
}

Gradients::Gradients(std::span<const FilledPath> fills) {
    for (const FilledPath& fill : fills) {
        if (!fill.outline->gradient)
            continue;
        const Gradient& gradient = *fill.outline->gradient;
        VERA_CHECK(!gradient.stops.empty());
        if (numbers_.try_emplace(&gradient, gradients_.size()).second)
            gradients_.push_back(&gradient);
    }
}

std::size_t Gradients::number_of(const Gradient& gradient) const {
    const auto found = numbers_.find(&gradient);
    VERA_CHECK(found != numbers_.end());
    return found->second;
}

std::string components(DrawingColor color) {
    // Three digits tell 256 values apart.
    const auto component = [](std::uint8_t value) { return decimal(value / 255.0, 3); };
    return component(color.r) + " " + component(color.g) + " " + component(color.b);
}

std::string shading_pattern(const Gradient& gradient) {
    const bool linear = gradient.shape == Gradient::Shape::linear;
    return fmt::format(
        "/PatternType 2/Shading<</ShadingType {}/ColorSpace/DeviceRGB/Coords[{}]"
        "/Extend[true true]/Function{}>>",
        linear ? 2 : 3,
        linear ? "0 0 1 0" : "0 0 0 0 0 1",
        color_function(gradient.stops));
}

std::string pattern_matrix(const Gradient& gradient, PageSize page, double pixels_wide) {
    const double scale = page.width / pixels_wide;
    const DrawingPoint a = gradient.axis;
    const DrawingPoint b =
        gradient.shape == Gradient::Shape::linear ? DrawingPoint{-a.y, a.x} : gradient.other_axis;
    const auto number = [&](double value) { return decimal(value, matrix_digits); };
    return fmt::format(
        "[{} {} {} {} {} {}]",
        number(scale * a.x),
        number(-scale * a.y),
        number(scale * b.x),
        number(-scale * b.y),
        number(scale * gradient.start.x),
        number(page.height - scale * gradient.start.y));
}

} // namespace vera::detail
