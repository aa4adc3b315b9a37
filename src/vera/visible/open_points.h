// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/exact/packed_point.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/screen_scene.h"

#include <vector>

namespace vera {

/// Steps: where ways do not close by so little, a straight one may join them. That is a 64th of a
/// pixel of a picture 4096 pixels wide.
constexpr double short_way = 16;

/// The points at which pieces do not close: of some source that is seen beside them, more ways
/// round it end there than begin, or fewer. Not those that close together with others, each of
/// which is within that many steps of the next.
std::vector<PackedPoint>
open_points(const ScreenScene& scene, const VisiblePieces& pieces, double reach = short_way);

} // namespace vera
