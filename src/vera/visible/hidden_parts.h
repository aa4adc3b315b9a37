// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/edges.h"
#include "vera/visible/hidden_intersections.h"
#include "vera/visible/screen_scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// A part of an edge behind something, or behind a line that is seen.
struct HiddenPart {
    RationalPoint from;
    RationalPoint to;
    std::uint32_t edge = 0; ///< of the first of the edges that lie there; behind the last edge,
                            ///< the intersections
};

/// What of the edges no piece lies upon, exactly: hidden is what is not seen; and of hidden
/// intersections. Where several lie upon each other they are one. In the order of the lines through
/// them, and along these. Throws Cancelled.
std::vector<HiddenPart> hidden_parts(
    const ScreenScene& scene,
    const ScreenEdges& edges,
    std::span<const std::uint32_t> drawn,
    const VisiblePieces& pieces,
    std::span<const HiddenIntersection> intersections = {},
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
