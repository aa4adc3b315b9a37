// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/drawing.h"
#include "vera/visible/fill_sources.h"

namespace vera {

/// Adds what is seen of each face as areas of the drawing, in the order of the faces, and sets what
/// is behind them. Those that abut let nothing of that through: see trapping.h and underlays.h.
/// Not for style ids: see numbered_areas.h. Throws Cancelled.
void add_fills(
    const FillSources& sources,
    const Progress& progress,
    const CancelFlag* cancel,
    Drawing& drawing);

} // namespace vera
