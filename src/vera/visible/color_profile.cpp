// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/color_profile.h"

#include "vera/drawing/gradient.h"
#include "vera/visible/drawn_color.h"

#include <algorithm>

namespace vera {

namespace {

Color as_color(DrawingColor color) {
    return {color.r / 255.0, color.g / 255.0, color.b / 255.0};
}

} // namespace

ColorProfile::ColorProfile(
    const Gradient& gradient, std::span<const ColorSample> samples, double tolerance) {
    along_.reserve(samples.size());
    for (const ColorSample& sample : samples)
        along_.push_back(
            {gradient_offset(gradient, sample.point),
             0,
             weight_of(sample, tolerance),
             sample.slack,
             sample.color});
    std::ranges::stable_sort(along_, {}, &Along::offset);
    knots_ = {{along_.front().offset, 0, 0}, {along_.back().offset, 0, along_.size() - 1}};
    if (has_extent())
        place_samples_after(0);
}

std::vector<GradientStop> ColorProfile::stops() const {
    std::vector<GradientStop> stops(knots_.size());
    const std::vector<Color> values = values_at_knots();
    for (std::size_t i = 0; i < stops.size(); ++i)
        stops[i] = {knots_[i].offset, drawn_color(values[i])};
    return stops;
}

double ColorProfile::largest_error(std::span<const GradientStop> stops) const {
    double largest = 0;
    for (std::size_t knot = 0; knot + 1 < knots_.size(); ++knot) {
        const Color from = as_color(stops[knot].color);
        const Color way = as_color(stops[knot + 1].color) - from;
        for (const Along& sample : samples_after(knot))
            largest = std::max(largest, sample.error(from + sample.part * way));
    }
    return largest;
}

bool ColorProfile::add_knot() {
    constexpr double nearest = 1.0 / 64; // of knots
    double most = 0;
    const Along* where = nullptr;
    std::size_t after = 0;
    for (std::size_t knot = 0; knot + 1 < knots_.size(); ++knot) {
        const double width = knots_[knot + 1].offset - knots_[knot].offset;
        const Color from = along_[knots_[knot].sample].color;
        const Color way = along_[knots_[knot + 1].sample].color - from;
        for (const Along& sample : samples_after(knot)) {
            if (std::min(sample.part, 1 - sample.part) * width < nearest)
                continue;
            const double off = sample.error(from + sample.part * way);
            if (off > most) {
                most = off;
                where = &sample;
                after = knot;
            }
        }
    }
    if (where == nullptr)
        return false;
    const auto sample = static_cast<std::size_t>(where - along_.data());
    std::size_t first = sample;
    while (along_[first - 1].offset == where->offset)
        --first;
    knots_.insert(
        knots_.begin() + static_cast<std::ptrdiff_t>(after) + 1, {where->offset, first, sample});
    place_samples_after(after);
    place_samples_after(after + 1);
    return true;
}

std::span<const ColorProfile::Along> ColorProfile::samples_after(std::size_t knot) const {
    const std::size_t end = knot + 2 == knots_.size() ? along_.size() : knots_[knot + 1].first;
    return std::span(along_).subspan(knots_[knot].first, end - knots_[knot].first);
}

void ColorProfile::place_samples_after(std::size_t knot) {
    const double from = knots_[knot].offset;
    const double width = knots_[knot + 1].offset - from;
    const std::size_t count = samples_after(knot).size();
    for (Along& sample : std::span(along_).subspan(knots_[knot].first, count))
        sample.part = (sample.offset - from) / width;
}

/// The equations of least squares have three diagonals. None is singular, as each knot has a
/// sample of its own.
std::vector<Color> ColorProfile::values_at_knots() const {
    const std::size_t count = knots_.size();
    std::vector<double> diagonal(count, 0);
    std::vector<double> beside(count, 0); // of each and the next
    std::vector<Color> sums(count);
    for (std::size_t knot = 0; knot + 1 < count; ++knot)
        for (const Along& sample : samples_after(knot)) {
            const double to_next = sample.weight * sample.part;
            const double to_this = sample.weight - to_next;
            diagonal[knot] += to_this * (1 - sample.part);
            diagonal[knot + 1] += to_next * sample.part;
            beside[knot] += to_this * sample.part;
            sums[knot] += to_this * sample.color;
            sums[knot + 1] += to_next * sample.color;
        }
    for (std::size_t i = 1; i < count; ++i) {
        const double factor = beside[i - 1] / diagonal[i - 1];
        diagonal[i] -= factor * beside[i - 1];
        sums[i] = sums[i] - factor * sums[i - 1];
    }
    for (std::size_t i = count; i-- > 0;) {
        if (i + 1 < count)
            sums[i] = sums[i] - beside[i] * sums[i + 1];
        sums[i] = 1 / diagonal[i] * sums[i];
    }
    return sums;
}

} // namespace vera
