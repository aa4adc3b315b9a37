// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/half_plane.h"

#include <span>
#include <vector>

namespace vera {

/// The parts of a neighbour's area, given by its rings, that lie within about a pixel of a border,
/// given by consecutive points that it has in common with the neighbour. What lies farther off is
/// left as it is: in a thin neighbour, its other border.
std::vector<BorderRing>
seam_strips(std::span<const BorderPoint> border, const std::vector<BorderRing>& neighbour);

/// Lets the strips' sides along the border's curves reach back across them by a trace.
void reach_back(
    std::span<const BorderPoint> border,
    const BorderCurves& curves,
    std::vector<BorderRing>& strips);

} // namespace vera
