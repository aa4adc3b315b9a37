// SPDX-License-Identifier: Apache-2.0
#include "vera/image/oklab.h"

#include "vera/math/elementary.h"

namespace vera {

namespace {

double cube_root(double value) {
    return value < 0 ? -power(-value, 1.0 / 3) : power(value, 1.0 / 3);
}

std::uint8_t encoded(double light) {
    const double value = 255 * srgb_encoded(light > 0 ? (light < 1 ? light : 1) : 0);
    return static_cast<std::uint8_t>(value + 0.5);
}

} // namespace

LinearRgb linear_light(Rgb8 color) {
    static const std::array<double, 256> table = [] {
        std::array<double, 256> decoded = {};
        for (std::size_t i = 0; i < decoded.size(); ++i)
            decoded[i] = srgb_decoded(static_cast<double>(i) / 255);
        return decoded;
    }();
    return {table[color[0]], table[color[1]], table[color[2]]};
}

Oklab oklab(const LinearRgb& light) {
    const auto [r, g, b] = light;
    const double l = cube_root(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
    const double m = cube_root(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
    const double s = cube_root(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
    return {
        0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
        1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
        0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

Oklab oklab(Rgb8 color) {
    return oklab(linear_light(color));
}

Rgb8 rgb8(const Oklab& color) {
    const auto cube = [](double value) { return value * value * value; };
    const double l = cube(color.lightness + 0.3963377774 * color.a + 0.2158037573 * color.b);
    const double m = cube(color.lightness - 0.1055613458 * color.a - 0.0638541728 * color.b);
    const double s = cube(color.lightness - 0.0894841775 * color.a - 1.2914855480 * color.b);
    return rgb8(LinearRgb{
        4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
        -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
        -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s});
}

Rgb8 rgb8(const LinearRgb& light) {
    return {encoded(light[0]), encoded(light[1]), encoded(light[2])};
}

} // namespace vera
