// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vera {

/// Red, green and blue, each from 0 (none) upwards; display-referred: 1 is what a screen shows as
/// 255.
struct Color {
    double r = 0;
    double g = 0;
    double b = 0;

    friend constexpr bool operator==(const Color&, const Color&) = default;
};

constexpr Color operator+(Color a, Color b) {
    return {a.r + b.r, a.g + b.g, a.b + b.b};
}

constexpr Color operator-(Color a, Color b) {
    return {a.r - b.r, a.g - b.g, a.b - b.b};
}

constexpr Color operator*(Color a, Color b) {
    return {a.r * b.r, a.g * b.g, a.b * b.b};
}

constexpr Color operator*(double factor, Color a) {
    return {factor * a.r, factor * a.g, factor * a.b};
}

constexpr Color& operator+=(Color& a, Color b) {
    return a = a + b;
}

constexpr bool is_black(Color a) {
    return a == Color{};
}

constexpr double max_component(Color a) {
    const double larger = a.r > a.g ? a.r : a.g;
    return larger > a.b ? larger : a.b;
}

/// Channel by channel.
constexpr Color min(Color a, Color b) {
    return {a.r < b.r ? a.r : b.r, a.g < b.g ? a.g : b.g, a.b < b.b ? a.b : b.b};
}

constexpr Color max(Color a, Color b) {
    return {a.r > b.r ? a.r : b.r, a.g > b.g ? a.g : b.g, a.b > b.b ? a.b : b.b};
}

constexpr Color clamped(Color a) {
    // Written so that what is not a number becomes 0.
    const auto clamp = [](double value) { return value > 0 ? (value < 1 ? value : 1) : 0; };
    return {clamp(a.r), clamp(a.g), clamp(a.b)};
}

} // namespace vera
