// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/line_fit.h"

#include <algorithm>
#include <array>
#include <functional>
#include <stdexcept>

namespace vera {

namespace {

using Quantiles = std::array<double, 30>;

constexpr Quantiles one_way = {6.314, 2.920, 2.353, 2.132, 2.015, 1.943, 1.895, 1.860,
                               1.833, 1.812, 1.796, 1.782, 1.771, 1.761, 1.753, 1.746,
                               1.740, 1.734, 1.729, 1.725, 1.721, 1.717, 1.714, 1.711,
                               1.708, 1.706, 1.703, 1.701, 1.699, 1.697};
constexpr Quantiles both_ways = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306,
                                 2.262,  2.228, 2.201, 2.179, 2.160, 2.145, 2.131, 2.120,
                                 2.110,  2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064,
                                 2.060,  2.056, 2.052, 2.048, 2.045, 2.042};

double quantile(const Quantiles& table, std::size_t freedom) {
    return table.at(std::min(freedom, table.size()) - 1);
}

double mean(std::span<const double> values) {
    double sum = 0;
    for (const double value : values)
        sum += value;
    return sum / static_cast<double>(values.size());
}

} // namespace

LineFit line_fit(std::span<const double> xs, std::span<const double> ys) {
    // Not by the spread, which rounding may leave above 0.
    if (std::adjacent_find(xs.begin(), xs.end(), std::not_equal_to<>()) == xs.end())
        throw std::invalid_argument("a line is told by points of different x");
    LineFit fit;
    fit.middle_x = mean(xs);
    fit.middle_y = mean(ys);
    double xy = 0;
    for (std::size_t i = 0; i < xs.size(); ++i) {
        const double x = xs[i] - fit.middle_x;
        const double y = ys[i] - fit.middle_y;
        fit.spread += x * x;
        xy += x * y;
        fit.total += y * y;
    }
    fit.slope = xy / fit.spread;
    // Not total - slope xy, which cancels where points lie on a line.
    for (std::size_t i = 0; i < xs.size(); ++i) {
        const double rest = ys[i] - fit.at(xs[i]);
        fit.left += rest * rest;
    }
    return fit;
}

double student_one_way(std::size_t freedom) {
    return quantile(one_way, freedom);
}

double student_both_ways(std::size_t freedom) {
    return quantile(both_ways, freedom);
}

} // namespace vera
