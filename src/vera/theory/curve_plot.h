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

} // namespace vera
