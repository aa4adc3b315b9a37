// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/theory/covered_union.h"

#include <cstdint>
#include <vector>

namespace vera {

/// The corners of a closed way along which an area lies on the left: round a part of it, or, to the
/// right, round a hole in it. It turns at each. The first one is its smallest.
using GridRing = std::vector<GridCorner>;

/// The edges of an area's border, put together: by their first corners. Parts that meet in a corner
/// only are apart. O(m log m) for m edges, which are sorted; comparisons are added to the count.
std::vector<GridRing> grid_rings(std::vector<GridEdge> edges, std::uint64_t& comparisons);

} // namespace vera
