// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/growth.h"

#include "vera/math/elementary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace vera {

namespace {

/// Student's t with 1, 2, ... degrees of freedom, the last one for all beyond, where it is too
/// large by a hundredth or two.
constexpr std::array<double, 30> student_one_way = {
    6.314, 2.920, 2.353, 2.132, 2.015, 1.943, 1.895, 1.860, 1.833, 1.812,
    1.796, 1.782, 1.771, 1.761, 1.753, 1.746, 1.740, 1.734, 1.729, 1.725,
    1.721, 1.717, 1.714, 1.711, 1.708, 1.706, 1.703, 1.701, 1.699, 1.697};
constexpr std::array<double, 30> student_both_ways = {
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
    2.201,  2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086,
    2.080,  2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042};

double student(const std::array<double, 30>& table, std::size_t freedom) {
    return table.at(std::min(freedom, table.size()) - 1);
}

void require_positive(std::span<const double> sizes, std::span<const double> counts) {
    if (sizes.size() != counts.size())
        throw std::invalid_argument("growth is that of as many counts as sizes");
    for (std::size_t i = 0; i < sizes.size(); ++i)
        if (!(sizes[i] > 0 && counts[i] > 0))
            throw std::invalid_argument(
                "growth is that of positive counts over positive sizes; number "
                + std::to_string(i + 1) + " is not");
}

struct Logarithms {
    std::vector<double> of_sizes;
    std::vector<double> of_counts;
};

Logarithms logarithms(std::span<const double> sizes, std::span<const double> counts) {
    require_positive(sizes, counts);
    Logarithms logs;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        logs.of_sizes.push_back(log2_of(sizes[i]));
        logs.of_counts.push_back(log2_of(counts[i]));
    }
    return logs;
}

double mean(std::span<const double> values) {
    double sum = 0;
    for (const double value : values)
        sum += value;
    return sum / static_cast<double>(values.size());
}

} // namespace

Growth growth(std::span<const double> sizes, std::span<const double> counts) {
    const Logarithms logs = logarithms(sizes, counts);
    if (sizes.size() < least_sizes_of_growth)
        throw std::invalid_argument("growth is told by 3 sizes or more");
    const double mean_x = mean(logs.of_sizes);
    const double mean_y = mean(logs.of_counts);
    double xx = 0;
    double xy = 0;
    double yy = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const double x = logs.of_sizes[i] - mean_x;
        const double y = logs.of_counts[i] - mean_y;
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    if (!(xx > 0))
        throw std::invalid_argument("growth is told by different sizes");
    Growth found;
    found.exponent = xy / xx;
    const double left = std::fmax(yy - found.exponent * xy, 0);
    const std::size_t freedom = sizes.size() - 2;
    const double error = std::sqrt(left / static_cast<double>(freedom) / xx);
    found.uncertainty = student(student_one_way, freedom) * error;
    found.half_interval = student(student_both_ways, freedom) * error;
    found.factor = exp2_of(mean_y - found.exponent * mean_x);
    found.r_squared = yy > 0 ? 1 - left / yy : 1;
    return found;
}

std::vector<double> local_exponents(std::span<const double> sizes, std::span<const double> counts) {
    const Logarithms logs = logarithms(sizes, counts);
    std::vector<double> exponents;
    for (std::size_t i = 1; i < sizes.size(); ++i)
        exponents.push_back(
            (logs.of_counts[i] - logs.of_counts[i - 1])
            / (logs.of_sizes[i] - logs.of_sizes[i - 1]));
    return exponents;
}

} // namespace vera
