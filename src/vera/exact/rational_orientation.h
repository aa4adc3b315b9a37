// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/exact/screen_point.h"

namespace vera {

/// The sign of twice the area of the triangle, exactly: positive where c lies to the left of the
/// way from a to b, if y grows upward. Denominators must be those of crossings of segments of the
/// grid, or less than 2^46.
int orientation(const RationalPoint& a, const RationalPoint& b, const RationalPoint& c);

} // namespace vera
