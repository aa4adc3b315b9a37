// SPDX-License-Identifier: Apache-2.0
// The residual bootstrap (Efron 1979; Davison and Hinkley 1997, section 6.2.3): how far a fitted
// power may be off, told by the residuals themselves. Student's t takes them for normal noise; here
// residuals are drawn with replacement, added to the fit, and fitted again, many times. A residual
// at the border of the sizes, which the line follows more closely, is enlarged by 1 / sqrt(1 - its
// leverage).
//
// Its intervals are a check. Of few sizes they are narrower than those of t: quantiles of so few
// residuals do not know how rarely a large one comes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace vera {

struct Interval {
    double lower = 0;
    double upper = 0;
};

/// Of the exponents of the resamples.
struct ResampledGrowth {
    Interval both_ways; ///< 2.5 % lie below it and 2.5 % above
    Interval one_way;   ///< 5 % lie below it and 5 % above
};

constexpr std::size_t usual_resamples = 2000;

/// Of sizes and counts as growth() takes them; throws likewise, and for fewer than 40 resamples.
/// Random numbers come from a counter, so that it is the same on every machine.
ResampledGrowth resampled_growth(
    std::span<const double> sizes,
    std::span<const double> counts,
    std::size_t resamples = usual_resamples,
    std::uint64_t seed = 1);

} // namespace vera
