// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/half_plane.h"

#include <span>
#include <vector>

namespace vera {

/// The parts of a neighbour's area, given by its rings, that lie within about a pixel of a border,
/// given by consecutive points that it has in common with the neighbour. What lies farther off is
/// left as it is: in a thin neighbour, its other border.
std::vector<PointChain>
seam_strips(std::span<const DrawingPoint> border, const std::vector<PointChain>& neighbour);

} // namespace vera
