// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/gradient_numbers.h"

#include "vera/base/check.h"
#include "vera/drawing/document_text.h"

#include <algorithm>
#include <cstring>

namespace vera::detail {

namespace {

constexpr std::uint32_t nobody = ~std::uint32_t{0};

void pack(double value, std::string& bytes) {
    value += 0.0; // both zeros are equal
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
}

void pack(DrawingPoint point, std::string& bytes) {
    pack(point.x, bytes);
    pack(point.y, bytes);
}

/// The same bytes for equal gradients alone: all but the stops has a length that the first tells.
void pack(const Gradient& gradient, std::string& bytes) {
    const bool has_other = gradient.other_axis != DrawingPoint{};
    bytes += static_cast<char>(2 * static_cast<int>(gradient.shape) + (has_other ? 1 : 0));
    pack(gradient.start, bytes);
    pack(gradient.axis, bytes);
    if (has_other)
        pack(gradient.other_axis, bytes);
    for (const GradientStop& stop : gradient.stops) {
        pack(stop.offset, bytes);
        for (const std::uint8_t component : {stop.color.r, stop.color.g, stop.color.b})
            bytes += static_cast<char>(component);
    }
}

} // namespace

GradientNumbers::Number GradientNumbers::of(const Gradient& gradient) {
    VERA_CHECK(!gradient.stops.empty());
    if (2 * (count() + 1) > table_.size())
        grow();
    at_hand_.clear();
    pack(gradient, at_hand_);
    std::uint32_t& number = table_[place_of(at_hand_)];
    if (number != nobody)
        return {number, false};
    number = static_cast<std::uint32_t>(count());
    bytes_ += at_hand_;
    ends_.push_back(bytes_.size());
    return {number, true};
}

std::string_view GradientNumbers::packed(std::size_t number) const {
    const std::size_t begin = number == 0 ? 0 : ends_[number - 1];
    return std::string_view(bytes_).substr(begin, ends_[number] - begin);
}

std::size_t GradientNumbers::place_of(std::string_view gradient) const {
    const std::size_t last = table_.size() - 1; // a power of two less one
    std::size_t place = hash_of(gradient) & last;
    while (table_[place] != nobody && packed(table_[place]) != gradient)
        place = (place + 1) & last;
    return place;
}

void GradientNumbers::grow() {
    table_.assign(std::max<std::size_t>(16, 2 * table_.size()), nobody);
    for (std::size_t i = 0; i < count(); ++i)
        table_[place_of(packed(i))] = static_cast<std::uint32_t>(i);
}

} // namespace vera::detail
