// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/math/color.h"

namespace vera {

/// How far along the gradient the point is: below 0 before its beginning, above 1 behind its end.
double gradient_offset(const Gradient& gradient, DrawingPoint point);

/// What the gradient shows at the point, 1 for 255, before a screen rounds it.
Color color_at(const Gradient& gradient, DrawingPoint point);

} // namespace vera
