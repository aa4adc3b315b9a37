// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/drawing.h"
#include "vera/visible/fill_sources.h"
#include "vera/visible/region_outlines.h"

#include <vector>

namespace vera {

/// Facets narrower than a pixel, and what shadows leave of them, let through what lies behind
/// several of them. So a piece of many regions is painted as a whole before all faces, in the one
/// colour or gradient that is nearest to the light in their middles: one outline for each part of
/// it that hangs together. Throws Cancelled.
std::vector<FilledOutline> facet_underlays(
    const FillSources& sources,
    const RegionOutlines& regions,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
