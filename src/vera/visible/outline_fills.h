// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/drawing.h"
#include "vera/visible/fill_sources.h"

#include <memory>

namespace vera {

/// Adds what is seen of each face as areas of the drawing, in the order of the faces, and sets what
/// is behind them. Those that abut let nothing of that through: see trapping.h and underlays.h.
/// Not for style ids: see numbered_areas.h. Throws Cancelled.
void add_fills(
    const FillSources& sources,
    const Progress& progress,
    const CancelFlag* cancel,
    Drawing& drawing);

/// The same, but for the faces themselves, which drawing.later_fills makes from the sources when
/// they are asked for. It keeps `kept`; all that the sources refer to must be part of that, or
/// outlive the drawing. Later nothing is asked of the map's vertices and, but in style shaded, of
/// the facets and the faces.
void add_later_fills(
    const FillSources& sources,
    std::shared_ptr<const void> kept,
    const Progress& progress,
    const CancelFlag* cancel,
    Drawing& drawing);

} // namespace vera
