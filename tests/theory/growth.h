// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace vera::testing {

/// Of counts over sizes: the exponent of the power of the size that they grow with, by least
/// squares of the logarithms, and how far it is sure, one way, at 95 %.
struct Growth {
    double exponent = 0;
    double uncertainty = 0;
};

/// Of as many counts as sizes, 4 to 12.
Growth growth(const std::vector<double>& sizes, const std::vector<double>& counts);

} // namespace vera::testing
