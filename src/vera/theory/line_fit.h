// SPDX-License-Identifier: Apache-2.0
// Least squares of a line, and how sure it is when what is left is normal noise: what the fits of
// growth share.
#pragma once

#include <cstddef>
#include <span>

namespace vera {

/// The line nearest to points, by the squares of what is left in y.
struct LineFit {
    double slope = 0;
    double middle_x = 0; ///< the means, through which it goes
    double middle_y = 0;
    double spread = 0; ///< the sum of (x - middle_x)^2
    double total = 0;  ///< the sum of (y - middle_y)^2
    double left = 0;   ///< the sum of (y - at(x))^2

    double at(double x) const { return middle_y + slope * (x - middle_x); }
};

/// Of as many xs as ys, 2 or more. Throws std::invalid_argument where all xs are equal.
LineFit line_fit(std::span<const double> xs, std::span<const double> ys);

/// Student's t with so many degrees of freedom (1 or more), which 95 % are below, or 95 % are
/// between it and its negative. Tabled to three decimals up to 30, the last one for all beyond,
/// where it is too large by up to 4 hundredths of it.
double student_one_way(std::size_t freedom);
double student_both_ways(std::size_t freedom);

} // namespace vera
