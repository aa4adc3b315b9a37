// SPDX-License-Identifier: Apache-2.0
#include "theory/growth.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace vera::testing {

Growth growth(const std::vector<double>& sizes, const std::vector<double>& counts) {
    // Student's t at 95 %, one-sided, with 2 to 10 degrees of freedom.
    constexpr std::array<double, 9> student = {
        2.920, 2.353, 2.132, 2.015, 1.943, 1.895, 1.860, 1.833, 1.812};
    const auto n = static_cast<double>(sizes.size());
    double mean_x = 0;
    double mean_y = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        mean_x += std::log(sizes[i]) / n;
        mean_y += std::log(counts[i]) / n;
    }
    double xx = 0;
    double xy = 0;
    double yy = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const double x = std::log(sizes[i]) - mean_x;
        const double y = std::log(counts[i]) - mean_y;
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    const double exponent = xy / xx;
    const double left = std::fmax(yy - exponent * xy, 0);
    return {exponent, student.at(sizes.size() - 4) * std::sqrt(left / (n - 2) / xx)};
}

} // namespace vera::testing
