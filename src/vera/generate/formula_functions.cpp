// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/formula_functions.h"

#include "vera/math/elementary.h"

#include <algorithm>
#include <numbers>

namespace vera {

namespace {

constexpr double degrees_per_radian = 180 / std::numbers::pi;

/// Far more than what the functions of numbers are off by: 4e-15 of the result, or of 1.
constexpr double relative_error = 4e-15;
constexpr double absolute_error = 4e-15;

Interval within_error(double lower, double upper) {
    if (lower != lower || upper != upper)
        return Interval::whole();
    const auto off = [](double value) {
        return std::isinf(value) ? 0 : relative_error * std::abs(value) + absolute_error;
    };
    return {lower - off(lower), upper + off(upper)};
}

/// Whether some number first + 4 n, n whole, lies between the two, or within rounding of them.
bool is_turn_between(double first, double lower, double upper) {
    constexpr double slack = 1e-9;
    const double n = std::ceil((lower - slack - first) / 4);
    return first + 4 * n <= upper + slack;
}

/// The sine of so many quarter turns more than the angle.
Interval sine_ahead(const Interval& angle, double quarters) {
    // Beyond that, an angle tells too little of where in a turn it is.
    constexpr double farthest = 1e5;
    if (!(magnitude(angle) < farthest) || !(angle.upper - angle.lower < 6))
        return {-1, 1};
    const auto at = [&](double a) { return quarters == 0 ? sine(a) : cosine(a); };
    // An angle in degrees is off by a few parts in 2^53 of itself.
    const double off = absolute_error + 1e-15 * magnitude(angle);
    Interval result = {
        std::min(at(angle.lower), at(angle.upper)) - off,
        std::max(at(angle.lower), at(angle.upper)) + off};
    const double lower = angle.lower / (std::numbers::pi / 2) + quarters;
    const double upper = angle.upper / (std::numbers::pi / 2) + quarters;
    if (is_turn_between(1, lower, upper))
        result.upper = 1;
    if (is_turn_between(-1, lower, upper))
        result.lower = -1;
    return {std::max(result.lower, -1.0), std::min(result.upper, 1.0)};
}

} // namespace

double sine(double angle) {
    return sin_degrees(angle * degrees_per_radian);
}

double cosine(double angle) {
    return cos_degrees(angle * degrees_per_radian);
}

double exponential(double value) {
    return exp2_of(value * std::numbers::log2e);
}

double logarithm(double value) {
    return log2_of(value) * std::numbers::ln2;
}

double square_root(double value) {
    return std::sqrt(value);
}

double arc_tangent(double value) {
    if (std::isnan(value))
        return value;
    const double size = std::abs(value);
    // To [0, 1], then to [-tan 22.5, tan 22.5] degrees.
    const bool inverted = size > 1;
    const double x = inverted ? 1 / size : size;
    const bool turned = x > std::numbers::sqrt2 - 1;
    const double z = turned ? (x - 1) / (x + 1) : x;
    const double y = z * z;
    double sum = 0;
    for (int odd = 47; odd >= 3; odd -= 2)
        sum = y * (1.0 / odd - sum);
    double angle = z - z * sum;
    if (turned)
        angle = std::numbers::pi / 4 + angle;
    if (inverted)
        angle = std::numbers::pi / 2 - angle;
    return value < 0 ? -angle : angle;
}

Interval sine(const Interval& angle) {
    return sine_ahead(angle, 0);
}

Interval cosine(const Interval& angle) {
    return sine_ahead(angle, 1);
}

Interval exponential(const Interval& value) {
    // The exponent of 2 is off by so many parts of itself, and the result by as much.
    const auto at = [](double x, double sign) {
        const double result = exponential(x);
        if (std::isinf(result) || std::isinf(x))
            return sign < 0 && std::isinf(result) ? std::numeric_limits<double>::max() : result;
        constexpr double least = 1e-300;
        return result * (1 + sign * (relative_error + 1e-15 * std::abs(x))) + sign * least;
    };
    return {std::max(0.0, at(value.lower, -1)), at(value.upper, 1)};
}

Interval logarithm(const Interval& value) {
    if (!(value.lower > 0))
        return Interval::whole();
    return within_error(logarithm(value.lower), logarithm(value.upper));
}

Interval square_root(const Interval& value) {
    if (!(value.lower >= 0))
        return Interval::whole();
    const Interval result = widened(std::sqrt(value.lower), std::sqrt(value.upper));
    return {std::max(result.lower, 0.0), result.upper};
}

Interval arc_tangent(const Interval& value) {
    return within_error(arc_tangent(value.lower), arc_tangent(value.upper));
}

} // namespace vera
