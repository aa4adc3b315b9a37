// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vera {

/// All numbers from lower to upper, of which either may be infinite. Every operation gives an
/// interval that holds the exact results for all numbers of its arguments: ends are rounded
/// outward. Where a function is not defined for all of them, the result is whole(): nothing is
/// known.
struct Interval {
    double lower = 0;
    double upper = 0;

    constexpr Interval() = default;

    constexpr Interval(double value) // NOLINT(google-explicit-constructor): as numbers are
        : lower(value)
        , upper(value) {}

    constexpr Interval(double low, double high)
        : lower(low)
        , upper(high) {}

    static constexpr Interval whole() {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        return {-infinity, infinity};
    }

    constexpr bool contains(double value) const { return lower <= value && value <= upper; }

    constexpr bool is_bounded() const {
        constexpr double most = std::numeric_limits<double>::max();
        return lower >= -most && upper <= most;
    }
};

/// The next double above, or value itself where it is infinite.
constexpr double next_above(double value) {
    if (value == 0)
        return std::numeric_limits<double>::denorm_min();
    if (!(value < std::numeric_limits<double>::infinity()))
        return value;
    const auto bits = std::bit_cast<std::uint64_t>(value);
    return std::bit_cast<double>(value > 0 ? bits + 1 : bits - 1);
}

constexpr double next_below(double value) {
    return -next_above(-value);
}

/// The largest absolute value.
constexpr double magnitude(const Interval& a) {
    const double low = a.lower < 0 ? -a.lower : a.lower;
    const double high = a.upper < 0 ? -a.upper : a.upper;
    return low > high ? low : high;
}

/// The interval whose ends were rounded to nearest.
constexpr Interval widened(double lower, double upper) {
    if (lower != lower || upper != upper)
        return Interval::whole();
    return {next_below(lower), next_above(upper)};
}

constexpr Interval hull(const Interval& a, const Interval& b) {
    return {a.lower < b.lower ? a.lower : b.lower, a.upper > b.upper ? a.upper : b.upper};
}

constexpr bool is_zero(const Interval& a) {
    return a.lower == 0 && a.upper == 0;
}

constexpr Interval operator-(const Interval& a) {
    return {-a.upper, -a.lower};
}

// Sums and products with 0 are exact, so that what does not vary stays so.

constexpr Interval operator+(const Interval& a, const Interval& b) {
    if (is_zero(a))
        return b;
    if (is_zero(b))
        return a;
    return widened(a.lower + b.lower, a.upper + b.upper);
}

constexpr Interval operator-(const Interval& a, const Interval& b) {
    return a + -b;
}

namespace detail {

/// Of ends of intervals: 0 times an infinite end is 0.
constexpr double end_product(double a, double b) {
    return a == 0 || b == 0 ? 0 : a * b;
}

} // namespace detail

constexpr Interval operator*(const Interval& a, const Interval& b) {
    if (is_zero(a) || is_zero(b))
        return {};
    const double products[] = {
        detail::end_product(a.lower, b.lower),
        detail::end_product(a.lower, b.upper),
        detail::end_product(a.upper, b.lower),
        detail::end_product(a.upper, b.upper)};
    double lower = products[0];
    double upper = products[0];
    for (const double product : products) {
        if (product != product)
            return Interval::whole();
        lower = product < lower ? product : lower;
        upper = product > upper ? product : upper;
    }
    return widened(lower, upper);
}

constexpr Interval reciprocal(const Interval& a) {
    if (a.lower <= 0 && a.upper >= 0)
        return Interval::whole();
    return widened(1 / a.upper, 1 / a.lower);
}

constexpr Interval operator/(const Interval& a, const Interval& b) {
    return a * reciprocal(b);
}

constexpr Interval square(const Interval& a) {
    const double high = magnitude(a);
    const double low = a.contains(0) ? 0 : high == a.upper ? a.lower : a.upper;
    const Interval result = widened(low * low, high * high);
    return {result.lower > 0 ? result.lower : 0, result.upper};
}

} // namespace vera
