// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/drawing_style.h"
#include "vera/visible/map_sources.h"

namespace vera {

/// What areas are painted from.
struct FillSources : MapSources {
    DrawingStyle style = DrawingStyle::flat;
    double color_tolerance = 1.0 / 255; ///< of gradients: see PaintTolerance
    VisibleMap* given_map = nullptr; ///< the same map, where its vertices need not be kept; or null
};

} // namespace vera
