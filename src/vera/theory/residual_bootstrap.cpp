// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/residual_bootstrap.h"

#include "vera/base/random.h"
#include "vera/theory/growth.h"
#include "vera/theory/line_fit.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace vera {

namespace {

constexpr std::size_t least_resamples = 40; // of which one is 2.5 %

/// As large as the errors that they come from. A residual whose leverage is 1, at a size that alone
/// leaves the line no choice, is 0. What all have in common does not move a slope.
std::vector<double> enlarged_residuals(const LineFit& fit, const Logarithms& logs) {
    const std::size_t count = logs.of_sizes.size();
    std::vector<double> residuals(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double x = logs.of_sizes[i] - fit.middle_x;
        const double freedom = 1 - 1 / static_cast<double>(count) - x * x / fit.spread;
        constexpr double rounding = 1e-12;
        if (freedom > rounding)
            residuals[i] = (logs.of_counts[i] - fit.at(logs.of_sizes[i])) / std::sqrt(freedom);
    }
    return residuals;
}

/// Leaves out as many of either side as are that part of them.
Interval middle_part(std::span<const double> ascending, double each_side) {
    const auto left_out =
        static_cast<std::size_t>(each_side * static_cast<double>(ascending.size()));
    return {ascending[left_out], ascending[ascending.size() - 1 - left_out]};
}

} // namespace

ResampledGrowth resampled_growth(
    std::span<const double> sizes,
    std::span<const double> counts,
    std::size_t resamples,
    std::uint64_t seed) {
    if (resamples < least_resamples)
        throw std::invalid_argument("a bootstrap takes 40 resamples or more");
    const double exponent = growth(sizes, counts).exponent;
    const Logarithms logs = logarithms(sizes, counts);
    const LineFit fit = line_fit(logs.of_sizes, logs.of_counts);
    const std::vector<double> residuals = enlarged_residuals(fit, logs);
    std::vector<double> exponents;
    for (std::size_t sample = 0; sample < resamples; ++sample) {
        // The fit itself has the slope that it has: only what is added moves it.
        double moved = 0;
        for (std::size_t i = 0; i < residuals.size(); ++i) {
            const std::uint64_t drawn = (random(seed, sample, i) >> 32) * residuals.size() >> 32;
            moved += (logs.of_sizes[i] - fit.middle_x) * residuals[drawn];
        }
        exponents.push_back(exponent + moved / fit.spread);
    }
    std::sort(exponents.begin(), exponents.end());
    return {middle_part(exponents, 0.025), middle_part(exponents, 0.05)};
}

} // namespace vera
