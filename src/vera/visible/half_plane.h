// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/border_ring.h"

#include <vector>

namespace vera {

/// The points whose way along the normal is at most reach. The normal need not be unit.
struct HalfPlane {
    DrawingPoint normal;
    double reach = 0;
};

using PointChain = std::vector<DrawingPoint>;

/// What of the areas lies in the half plane. The rings must run alike round areas, and against that
/// round holes. Those of which nothing is left are left out. What is left of a side along a curve
/// is one.
std::vector<BorderRing> cut_rings(const std::vector<BorderRing>& rings, const HalfPlane& half);

/// What of the lines lies in the half plane, in their order.
std::vector<PointChain> cut_lines(const std::vector<PointChain>& lines, const HalfPlane& half);

} // namespace vera
