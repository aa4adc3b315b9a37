// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/drawing.h"
#include "vera/visible/fill_sources.h"
#include "vera/visible/region_outlines.h"

#include <vector>

namespace vera {

struct ShadedUnderlays {
    std::vector<FilledOutline> outlines;
    std::vector<bool> has_one; ///< each region
};

/// Regions narrower than a pixel, and places where several meet in one, let through what lies
/// behind all of them: of each, what smooths edges leaves. So what hangs together of two regions
/// and more is painted as a whole before all faces, roughly as the light in their middles is.
/// Throws Cancelled.
ShadedUnderlays shaded_underlays(
    const FillSources& sources,
    const RegionOutlines& regions,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
