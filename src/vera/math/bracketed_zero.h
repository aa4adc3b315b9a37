// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace vera {

/// A zero of a continuous function whose values at low and high have different signs, to within a
/// rounding of its place: by the parabola through three places where that is sure to help, else by
/// halves (Chandrupatla 1997). Usually asks for some eight values, and never for more than 200.
template <typename Function>
double bracketed_zero(
    double low, double low_value, double high, double high_value, const Function& value_at) {
    // The zero lies between newest and opposite; former is the place that one of them has replaced.
    double newest = low;
    double newest_value = low_value;
    double opposite = high;
    double opposite_value = high_value;
    double part = low_value / (low_value - high_value); // of the way from newest to opposite
    for (int step = 0; step < 200; ++step) {
        const double v = newest + part * (opposite - newest);
        const double value = value_at(v);
        if (value == 0)
            return v;
        double former = newest;
        double former_value = newest_value;
        if ((value > 0) != (newest_value > 0)) {
            former = opposite;
            former_value = opposite_value;
            opposite = newest;
            opposite_value = newest_value;
        }
        newest = v;
        newest_value = value;

        const bool newest_is_best = std::abs(newest_value) < std::abs(opposite_value);
        const double best = newest_is_best ? newest : opposite;
        const double least_part = 0x1p-53 * std::abs(best) / std::abs(opposite - newest);
        if (!(least_part < 0.5))
            return best;
        const double xi = (newest - opposite) / (former - opposite);
        const double phi = (newest_value - opposite_value) / (former_value - opposite_value);
        part = 0.5;
        if (phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi)
            part = newest_value / (opposite_value - newest_value) * former_value
                    / (opposite_value - former_value)
                + (former - newest) / (opposite - newest) * newest_value
                    / (former_value - newest_value) * opposite_value
                    / (former_value - opposite_value);
        part = std::clamp(part, least_part, 1 - least_part);
    }
    return newest;
}

} // namespace vera
