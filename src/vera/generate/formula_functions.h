// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/generate/interval.h"

namespace vera {

// The functions of formulas, of numbers and of intervals. Those of numbers have the same bits on
// every machine, and are not a number where they are not defined. Those of intervals hold the exact
// value for every number of the interval, whatever the error of those of numbers is.
//
// Angles are in radians.

double sine(double angle);
double cosine(double angle);
double exponential(double value);
double logarithm(double value);
double square_root(double value);
double arc_tangent(double value);

Interval sine(const Interval& angle);
Interval cosine(const Interval& angle);
Interval exponential(const Interval& value);
Interval logarithm(const Interval& value);
Interval square_root(const Interval& value);
Interval arc_tangent(const Interval& value);

constexpr double square(double a) {
    return a * a;
}

constexpr double reciprocal(double a) {
    return 1 / a;
}

} // namespace vera
