// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/theory/curve.h"

#include <span>
#include <string>

namespace vera {

/// The curves as an SVG: a panel with logarithmic axes for those of each name, with what was
/// counted, the powers that were fitted, and the bounds. The same curves give the same bytes.
std::string curve_plot(std::span<const Curve> curves);

/// A power for people: "0.47 ± 0.05", where the second number is half the interval of 95 %.
std::string exponent_text(const Growth& growth);

/// "0.43 to 0.51"
std::string interval_text(const Interval& interval);

/// The formula that counts follow best, and the others that are not told apart from it:
/// "c n log n, or c n^1.08".
std::string followed_text(const Curve& curve);

} // namespace vera
