// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vera {

// Elementary functions whose bits depend on nothing but their argument. Those of libm differ with
// the machine and with the CPU's fused multiply-add, and whatever decides a pixel uses these.

/// Exact at multiples of 90 degrees, elsewhere within 2 units in the last place of the result or
/// 1e-16, whichever is more. Not a number for an infinite angle.
double sin_degrees(double angle_degrees);
double cos_degrees(double angle_degrees);

/// The logarithm to base 2 of a positive number, within 1e-15 of the result or absolutely.
double log2_of(double value);

/// 2 to the power of exponent, within 1e-15 of the result.
double exp2_of(double exponent);

/// base to the power of exponent, base >= 0; within 1e-13 of the result for results of 1e-30 to
/// 1e30.
double power(double base, double exponent);

/// The light that a display emits for a display-referred value, by the sRGB curve (IEC 61966-2-1);
/// below 0 the curve is continued as an odd function, above 1 by its formula.
double srgb_decoded(double value);

/// The inverse of srgb_decoded.
double srgb_encoded(double light);

} // namespace vera
