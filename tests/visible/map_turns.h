// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/visible_map.h"

#include <cstdint>
#include <map>

namespace vera::testing {

/// How often the rings of each region go round the point, in steps of the grid, added up; regions
/// of which that is 0 are left out.
std::map<std::uint32_t, int> turns_about(const VisibleMap& map, double x, double y);

/// Of all rings together, in steps of the grid.
double area_of(const VisibleMap& map);

} // namespace vera::testing
