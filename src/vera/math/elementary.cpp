// SPDX-License-Identifier: Apache-2.0
#include "vera/math/elementary.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace vera {

namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;

/// Taylor series on [-pi/4, pi/4]: the first term left out is below 1e-18 there.
double sin_near_zero(double x) {
    const double y = x * x;
    double sum = -1.0 / 1307674368000.0; // 15!
    sum = sum * y + 1.0 / 6227020800.0;  // 13!
    sum = sum * y - 1.0 / 39916800.0;
    sum = sum * y + 1.0 / 362880.0;
    sum = sum * y - 1.0 / 5040.0;
    sum = sum * y + 1.0 / 120.0;
    sum = sum * y - 1.0 / 6.0;
    return x + x * y * sum;
}

double cos_near_zero(double x) {
    const double y = x * x;
    double sum = 1.0 / 20922789888000.0; // 16!
    sum = sum * y - 1.0 / 87178291200.0; // 14!
    sum = sum * y + 1.0 / 479001600.0;
    sum = sum * y - 1.0 / 3628800.0;
    sum = sum * y + 1.0 / 40320.0;
    sum = sum * y - 1.0 / 720.0;
    sum = sum * y + 1.0 / 24.0;
    return 1 - 0.5 * y + y * y * sum;
}

/// sin of quarter_turns * 90 + angle_degrees.
double sin_of_turned(double angle_degrees, int quarter_turns) {
    // fmod is exact; the remainder that follows it is exact too.
    double rest = std::fmod(angle_degrees, 360.0);
    const double quarters = std::floor(rest / 90 + 0.5);
    rest -= 90 * quarters;
    const double x = rest * radians_per_degree;
    switch ((static_cast<int>(quarters) + quarter_turns) & 3) {
    case 0:
        return sin_near_zero(x);
    case 1:
        return cos_near_zero(x);
    case 2:
        return -sin_near_zero(x);
    default:
        return -cos_near_zero(x);
    }
}

} // namespace

double sin_degrees(double angle_degrees) {
    if (!std::isfinite(angle_degrees))
        return std::numeric_limits<double>::quiet_NaN();
    return sin_of_turned(angle_degrees, 0);
}

double cos_degrees(double angle_degrees) {
    if (!std::isfinite(angle_degrees))
        return std::numeric_limits<double>::quiet_NaN();
    return sin_of_turned(angle_degrees, 1);
}

double log2_of(double value) {
    if (!(value > 0))
        return value == 0 ? -std::numeric_limits<double>::infinity()
                          : std::numeric_limits<double>::quiet_NaN();
    if (std::isinf(value))
        return value;
    int exponent = 0;
    double mantissa = std::frexp(value, &exponent); // in [1/2, 1)
    if (mantissa < std::numbers::sqrt2 / 2) {
        mantissa *= 2;
        --exponent;
    }
    // ln m = 2 artanh((m - 1) / (m + 1)), |argument| < 0.172.
    const double z = (mantissa - 1) / (mantissa + 1);
    const double y = z * z;
    double sum = 0;
    for (int odd = 23; odd >= 3; odd -= 2)
        sum = (sum + 1.0 / odd) * y;
    const double natural = 2 * z + 2 * z * sum;
    return static_cast<double>(exponent) + natural * std::numbers::log2e;
}

double exp2_of(double exponent) {
    if (std::isnan(exponent))
        return exponent;
    if (exponent > 1024)
        return std::numeric_limits<double>::infinity();
    if (exponent < -1080)
        return 0;
    const double whole = std::floor(exponent + 0.5);
    const double x = (exponent - whole) * std::numbers::ln2; // |x| <= 0.347
    double sum = 1;
    for (int n = 16; n >= 1; --n)
        sum = 1 + sum * x / n;
    return std::ldexp(sum, static_cast<int>(whole));
}

double power(double base, double exponent) {
    if (exponent == 0)
        return 1;
    if (base == 0)
        return exponent > 0 ? 0 : std::numeric_limits<double>::infinity();
    return exp2_of(exponent * log2_of(base));
}

double srgb_decoded(double value) {
    const double size = std::abs(value);
    const double light = size <= 0.04045 ? size / 12.92 : power((size + 0.055) / 1.055, 2.4);
    return value < 0 ? -light : light;
}

double srgb_encoded(double light) {
    const double size = std::abs(light);
    const double value = size <= 0.0031308 ? size * 12.92 : 1.055 * power(size, 1 / 2.4) - 0.055;
    return light < 0 ? -value : value;
}

} // namespace vera
