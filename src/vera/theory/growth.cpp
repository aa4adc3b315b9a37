// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/growth.h"

#include "vera/math/elementary.h"
#include "vera/theory/line_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>

namespace vera {

namespace {

void require_positive(std::span<const double> sizes, std::span<const double> counts) {
    if (sizes.size() != counts.size())
        throw std::invalid_argument("growth is that of as many counts as sizes");
    for (std::size_t i = 0; i < sizes.size(); ++i)
        if (!(sizes[i] > 0 && counts[i] > 0))
            throw std::invalid_argument(
                "growth is that of positive counts over positive sizes; number "
                + std::to_string(i + 1) + " is not");
}

} // namespace

Logarithms logarithms(std::span<const double> sizes, std::span<const double> counts) {
    require_positive(sizes, counts);
    Logarithms logs;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        logs.of_sizes.push_back(log2_of(sizes[i]));
        logs.of_counts.push_back(log2_of(counts[i]));
    }
    return logs;
}

Growth growth(std::span<const double> sizes, std::span<const double> counts) {
    const Logarithms logs = logarithms(sizes, counts);
    if (sizes.size() < least_sizes_of_growth)
        throw std::invalid_argument("growth is told by 3 sizes or more");
    if (std::adjacent_find(sizes.begin(), sizes.end(), std::not_equal_to<>()) == sizes.end())
        throw std::invalid_argument("growth is told by different sizes");
    const LineFit fit = line_fit(logs.of_sizes, logs.of_counts);
    const std::size_t freedom = sizes.size() - 2;
    const double error = std::sqrt(fit.left / static_cast<double>(freedom) / fit.spread);
    Growth found;
    found.exponent = fit.slope;
    found.uncertainty = student_one_way(freedom) * error;
    found.half_interval = student_both_ways(freedom) * error;
    found.factor = exp2_of(fit.at(0));
    found.r_squared = fit.total > 0 ? 1 - fit.left / fit.total : 1;
    return found;
}

std::size_t first_to_fit(std::size_t points) {
    constexpr std::size_t least = 4;
    return points - std::min(points, std::max(least, (points + 1) / 2));
}

std::vector<double> local_exponents(std::span<const double> sizes, std::span<const double> counts) {
    const Logarithms logs = logarithms(sizes, counts);
    std::vector<double> exponents;
    if (std::adjacent_find(sizes.begin(), sizes.end()) != sizes.end())
        throw std::invalid_argument("no power leads from a size to an equal one");
    for (std::size_t i = 1; i < sizes.size(); ++i)
        exponents.push_back(
            (logs.of_counts[i] - logs.of_counts[i - 1])
            / (logs.of_sizes[i] - logs.of_sizes[i - 1]));
    return exponents;
}

} // namespace vera
