// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing.h"

#include <vector>

namespace vera {

/// The points whose way along the normal is at most reach. The normal need not be unit.
struct HalfPlane {
    DrawingPoint normal;
    double reach = 0;
};

using PointChain = std::vector<DrawingPoint>;

/// What of the areas lies in the half plane. The rings must run alike round areas, and against that
/// round holes. Those of which nothing is left are left out.
std::vector<PointChain> cut_rings(const std::vector<PointChain>& rings, const HalfPlane& half);

/// What of the lines lies in the half plane, in their order.
std::vector<PointChain> cut_lines(const std::vector<PointChain>& lines, const HalfPlane& half);

} // namespace vera
