// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/math/color.h"
#include "vera/visible/half_plane.h"

#include <optional>
#include <span>
#include <vector>

namespace vera::testing {

/// How often the rings go round the point, added up.
int turns_about(const std::vector<PointChain>& rings, DrawingPoint point);

/// Twice the area, as shoelaces give it.
double doubled_area(const std::vector<PointChain>& rings);

/// What the outlines show at the point, 1 for 255: the last one that covers it, by the definition
/// of SVG. Nothing where none does.
std::optional<Color> painted_color(std::span<const FilledOutline> fills, DrawingPoint point);

} // namespace vera::testing
