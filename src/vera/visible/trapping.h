// SPDX-License-Identifier: Apache-2.0
// Trapping, as printers call it: where two areas meet, what smooths edges lets through what lies
// behind both. So the one that is painted earlier goes on below the other.
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/drawing.h"
#include "vera/visible/region_outlines.h"
#include "vera/visible/region_paint.h"

#include <cstddef>
#include <span>
#include <vector>

namespace vera {

/// How wide each region is, in pixels: what it covers by half the length of its border. Throws
/// Cancelled.
std::vector<float> widths_of_regions(
    const RegionOutlines& regions,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// Lets the region of that number, painted, which has its rings, go on below those beside it that
/// are painted later: below the whole of those that are small, or so narrow that a strip below
/// their border would come out beyond them, which moves no silhouette, or, where that would mix
/// another colour into what lies beyond them, close to the common border; below the others, and
/// those of very many corners, as a seam, but for a region so narrow that the line would come out
/// on its own other side. The widths and colours are those of all regions.
void cover_seams(
    const RegionOutlines& regions,
    std::span<const float> widths,
    std::span<const DrawingColor> colors,
    std::size_t number,
    PaintedRegion& region);

/// Whether it gives the region a seam.
bool has_seams(const RegionOutlines& regions, std::span<const float> widths, std::size_t number);

/// The same for areas that change their colours from place to place: a region goes on below those
/// beside it only close to their common border, whatever their size.
void cover_seams_closely(const RegionOutlines& regions, std::size_t number, PaintedRegion& region);

/// Whether it gives the region a seam.
bool has_seams_closely(const RegionOutlines& regions, std::size_t number);

} // namespace vera
