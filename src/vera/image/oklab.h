// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace vera {

/// Red, green and blue of 8 bits, display-referred.
using Rgb8 = std::array<std::uint8_t, 3>;

/// A colour in Oklab (B. Ottosson, "A perceptual color space for image processing", 2020):
/// lightness from 0 to 1, and two axes of hue, in which equal distances look about equal.
struct Oklab {
    double lightness = 0;
    double a = 0;
    double b = 0;
};

/// Red, green and blue of linear light, 1 being white.
using LinearRgb = std::array<double, 3>;

/// By a table: quick.
LinearRgb linear_light(Rgb8 color);

Oklab oklab(const LinearRgb& light);
Oklab oklab(Rgb8 color);

/// The nearest colour of 8 bits; what lies outside is limited channel by channel.
Rgb8 rgb8(const Oklab& color);
Rgb8 rgb8(const LinearRgb& light);

constexpr double squared_distance(const Oklab& p, const Oklab& q) {
    return (p.lightness - q.lightness) * (p.lightness - q.lightness) + (p.a - q.a) * (p.a - q.a)
        + (p.b - q.b) * (p.b - q.b);
}

} // namespace vera
