// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/generate/formula_functions.h"

#include <cmath>

namespace vera {

/// A value that depends on u and v, with its first and second derivatives: forward differentiation.
/// Number is double or Interval; of intervals, each member holds what it is anywhere in a range of
/// u and v. Where a derivative does not exist, an interval's is whole() and a number's is of one
/// side.
template <typename Number>
struct Jet {
    Number value = 0;
    Number u = 0;
    Number v = 0;
    Number uu = 0;
    Number uv = 0;
    Number vv = 0;
};

template <typename Number>
Jet<Number> operator+(const Jet<Number>& a, const Jet<Number>& b) {
    return {a.value + b.value, a.u + b.u, a.v + b.v, a.uu + b.uu, a.uv + b.uv, a.vv + b.vv};
}

template <typename Number>
Jet<Number> operator-(const Jet<Number>& a) {
    return {-a.value, -a.u, -a.v, -a.uu, -a.uv, -a.vv};
}

template <typename Number>
Jet<Number> operator-(const Jet<Number>& a, const Jet<Number>& b) {
    return a + -b;
}

template <typename Number>
Jet<Number> operator*(const Jet<Number>& a, const Jet<Number>& b) {
    return {
        a.value * b.value,
        a.u * b.value + a.value * b.u,
        a.v * b.value + a.value * b.v,
        a.uu * b.value + Number(2) * (a.u * b.u) + a.value * b.uu,
        a.uv * b.value + a.u * b.v + a.v * b.u + a.value * b.uv,
        a.vv * b.value + Number(2) * (a.v * b.v) + a.value * b.vv};
}

/// A function of a, given its value and derivatives there: the chain rule.
template <typename Number>
Jet<Number>
chained(const Jet<Number>& a, const Number& value, const Number& first, const Number& second) {
    return {
        value,
        first * a.u,
        first * a.v,
        second * square(a.u) + first * a.uu,
        second * (a.u * a.v) + first * a.uv,
        second * square(a.v) + first * a.vv};
}

template <typename Number>
Jet<Number> reciprocal(const Jet<Number>& a) {
    const Number value = reciprocal(a.value);
    const Number squared = square(value);
    return chained(a, value, -squared, Number(2) * (squared * value));
}

template <typename Number>
Jet<Number> operator/(const Jet<Number>& a, const Jet<Number>& b) {
    return a * reciprocal(b);
}

template <typename Number>
Jet<Number> sine(const Jet<Number>& a) {
    const Number value = sine(a.value);
    return chained(a, value, cosine(a.value), -value);
}

template <typename Number>
Jet<Number> cosine(const Jet<Number>& a) {
    const Number value = cosine(a.value);
    return chained(a, value, -sine(a.value), -value);
}

template <typename Number>
Jet<Number> exponential(const Jet<Number>& a) {
    const Number value = exponential(a.value);
    return chained(a, value, value, value);
}

template <typename Number>
Jet<Number> logarithm(const Jet<Number>& a) {
    const Number first = reciprocal(a.value);
    return chained(a, logarithm(a.value), first, -square(first));
}

template <typename Number>
Jet<Number> square_root(const Jet<Number>& a) {
    const Number value = square_root(a.value);
    const Number first = Number(0.5) * reciprocal(value);
    return chained(a, value, first, -(Number(0.5) * (first * reciprocal(a.value))));
}

template <typename Number>
Jet<Number> arc_tangent(const Jet<Number>& a) {
    const Number first = reciprocal(Number(1) + square(a.value));
    return chained(a, arc_tangent(a.value), first, -(Number(2) * (a.value * square(first))));
}

/// a to a whole power.
template <typename Number>
Jet<Number> whole_power(const Jet<Number>& a, unsigned exponent) {
    const auto power = [&](unsigned n) {
        Number result = 1;
        Number factor = a.value;
        // Squares last, so that an even power of an interval is never below 0.
        for (unsigned bit = n; bit != 0; bit >>= 1U) {
            if ((bit & 1U) != 0)
                result = result * factor;
            factor = square(factor);
        }
        return result;
    };
    if (exponent == 0)
        return {Number(1)};
    const double n = exponent;
    return chained(
        a,
        power(exponent),
        Number(n) * power(exponent - 1),
        exponent < 2 ? Number(0) : Number(n * (n - 1)) * power(exponent - 2));
}

/// a to the power of a constant that is not whole; a >= 0.
template <typename Number>
Jet<Number> constant_power(const Jet<Number>& a, double exponent) {
    const auto power = [&](double p) { return exponential(Number(p) * logarithm(a.value)); };
    return chained(
        a,
        power(exponent),
        Number(exponent) * power(exponent - 1),
        Number(exponent) * Number(exponent - 1) * power(exponent - 2));
}

/// Not a number where one of them is none.
inline Jet<double> larger(const Jet<double>& a, const Jet<double>& b) {
    return a.value >= b.value || std::isnan(a.value) ? a : b;
}

inline Jet<Interval> larger(const Jet<Interval>& a, const Jet<Interval>& b) {
    if (a.value.lower > b.value.upper)
        return a;
    if (b.value.lower > a.value.upper)
        return b;
    return {
        {a.value.lower > b.value.lower ? a.value.lower : b.value.lower,
         a.value.upper > b.value.upper ? a.value.upper : b.value.upper},
        hull(a.u, b.u),
        hull(a.v, b.v),
        Interval::whole(),
        Interval::whole(),
        Interval::whole()};
}

template <typename Number>
Jet<Number> absolute(const Jet<Number>& a) {
    return larger(a, -a);
}

namespace detail {

/// Which of the formulas by the arc tangent of a quotient holds for the angle of (x, y).
enum class Quadrant { right, above, below, left_above, left_below, several };

inline Quadrant quadrant(double y, double x) {
    if (x > 0 && std::abs(y) <= x)
        return Quadrant::right;
    if (y > 0 && std::abs(x) <= y)
        return Quadrant::above;
    if (y < 0 && std::abs(x) <= -y)
        return Quadrant::below;
    if (x < 0)
        return y >= 0 ? Quadrant::left_above : Quadrant::left_below;
    return Quadrant::several;
}

/// Where one formula serves all numbers of both, it is the one that each of them takes alone: its
/// rounding may differ from another's by more than an end is rounded outward.
inline Quadrant quadrant(const Interval& y, const Interval& x) {
    const double highest = magnitude(y);
    const double widest = magnitude(x);
    if (x.lower > 0 && highest <= x.lower)
        return Quadrant::right;
    if (y.lower > 0 && widest <= y.lower)
        return Quadrant::above;
    if (y.upper < 0 && widest <= -y.upper)
        return Quadrant::below;
    if (x.lower > 0)
        return Quadrant::right;
    if (y.lower > 0)
        return Quadrant::above;
    if (y.upper < 0)
        return Quadrant::below;
    if (x.upper < 0 && y.lower >= 0)
        return Quadrant::left_above;
    return Quadrant::several;
}

/// Of (0, 0) the angle is 0; otherwise a coordinate is not a number, and so is the angle.
inline double unknown_angle(double y, double x) {
    return y + x;
}

inline Interval unknown_angle(const Interval&, const Interval&) {
    return Interval::whole();
}

/// pi / 2, and for intervals what holds the true one.
inline double quarter_turn(double) {
    return 1.5707963267948966;
}

inline Interval quarter_turn(const Interval&) {
    return widened(1.5707963267948966, 1.5707963267948966);
}

} // namespace detail

/// The angle of (x, y) from the x axis, in (-pi, pi].
template <typename Number>
Jet<Number> angle_of(const Jet<Number>& y, const Jet<Number>& x) {
    using detail::Quadrant;
    const Number quarter = detail::quarter_turn(y.value);
    const Jet<Number> turn = {quarter};
    switch (detail::quadrant(y.value, x.value)) {
    case Quadrant::right:
        return arc_tangent(y / x);
    case Quadrant::above:
        return turn - arc_tangent(x / y);
    case Quadrant::below:
        return -turn - arc_tangent(x / y);
    case Quadrant::left_above:
        return arc_tangent(y / x) + turn + turn;
    case Quadrant::left_below:
        return arc_tangent(y / x) - turn - turn;
    case Quadrant::several:
        break;
    }
    const Number unknown = detail::unknown_angle(y.value, x.value);
    return {unknown, unknown, unknown, unknown, unknown, unknown};
}

} // namespace vera
