// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/drawing.h"
#include "vera/visible/region_outlines.h"

#include <span>
#include <vector>

namespace vera {

/// Where three or more faces meet within a pixel, some of the background would come through,
/// whatever goes on below what. So what hangs together is painted as a whole before its faces: one
/// outline for each such area of several regions, in the mean of their colours. Throws Cancelled.
std::vector<FilledOutline> underlays(
    const RegionOutlines& regions,
    std::span<const DrawingColor> colors,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
