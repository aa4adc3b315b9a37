// SPDX-License-Identifier: Apache-2.0
// How what is counted grows with the size of the input: as which power of it, and how sure that is.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vera {

/// To base 2.
struct Logarithms {
    std::vector<double> of_sizes;
    std::vector<double> of_counts;
};

/// Of as many counts as sizes, all positive; otherwise throws std::invalid_argument.
Logarithms logarithms(std::span<const double> sizes, std::span<const double> counts);

/// Of counts over sizes: the power of the size that they grow with, by least squares of the
/// logarithms, and how far it may be off, by Student's t.
struct Growth {
    double exponent = 0;
    double uncertainty = 0;   ///< one way, at 95 %: it is less than the exponent with this added
    double half_interval = 0; ///< both ways, at 95 %
    double factor = 0;        ///< a count is about factor size^exponent
    double r_squared = 1;     ///< the part of what the logarithms vary by that the power tells
};

/// The fewest sizes that tell how sure an exponent is.
constexpr std::size_t least_sizes_of_growth = 3;

/// Of as many counts as sizes, 3 or more, all positive, and sizes not all equal; otherwise throws
/// std::invalid_argument. The same bits on every machine.
Growth growth(std::span<const double> sizes, std::span<const double> counts);

/// The first of so many points to which a power is fitted: the upper half of them, where what is
/// constant matters least, but four where there are as many.
std::size_t first_to_fit(std::size_t points);

/// From each size to the next: the power that would lead from the one count to the other. A drift
/// tells that the counts are no power of the size. Throws likewise, and where a size equals the one
/// before.
std::vector<double> local_exponents(std::span<const double> sizes, std::span<const double> counts);

} // namespace vera
