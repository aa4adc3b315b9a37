// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace vera {

/// The wish that A x be near b, with least <= x <= most.
struct BoundedLeastSquares {
    std::size_t columns = 0;
    std::vector<double> matrix; ///< A row by row, columns numbers each
    std::vector<double> right;  ///< b, a number for each row
    std::vector<double> least;  ///< a number for each column, as in most; not above it
    std::vector<double> most;
};

/// The x for which |A x - b| is least. The columns of A must be linearly independent, which makes
/// it the only one. An active set method (Stark and Parker 1995, BVLS), for few columns.
std::vector<double> solution(const BoundedLeastSquares& problem);

} // namespace vera
