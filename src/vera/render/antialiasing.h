// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/image.h"
#include "vera/render/generations.h"
#include "vera/render/raster.h"
#include "vera/render/statistics.h"
#include "vera/render/workspaces.h"
#include "vera/scene/picture_settings.h"

namespace vera {

/// The picture by controlled oversampling (ANTI-ALIAS), as follows.
///
/// Every pixel gets a ray through its centre, which colours it, and one elsewhere in it that only
/// asks what is hit. A pixel is refined where a neighbour of the eight shows another surface (see
/// same_surface), or a colour that differs by more than the tolerance from its own, unless the
/// colours of one surface change evenly from that neighbour to the opposite one.
///
/// A refined pixel gets a quarter of `samples` rays first, but no fewer than 4 if there are so
/// many, well spread. Where these, the centre or a neighbour show another surface, the rest only
/// ask what is hit: how much of the pixel a surface covers is known by all of them, and its colour
/// there by those that have one (see PixelStrata). The number of rays with a colour is doubled, to
/// twice `samples` (not more than 256), as long as their colours deviate from their surface's mean
/// by more than the tolerance times (4 rays / samples)^1.75.
///
/// A thing is thin where one of a pixel's rays sees it but fewer than 5 of the 5 x 5 centres around
/// do. Where one of 12 rays along a side of such a pixel, which only ask what is hit, sees
/// something thin, the neighbour across that side is refined as well, and so on
/// along the thing, which is not lost as long as it covers a tenth of a side. Where it lies before
/// a plain background, which 13 of the centres see, twice as many rays ask such pixels what is hit.
///
/// Which pixels are refined follows from these rules alone, not from the order of work.
RenderStatistics render_antialiased(
    const TracedScene& traced,
    const Raster& raster,
    const Antialiasing& settings,
    Image& image,
    ProgressMeter& done);

} // namespace vera
