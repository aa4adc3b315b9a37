// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/drawing.h"
#include "vera/visible/gradient_fit.h"
#include "vera/visible/half_plane.h"

#include <span>
#include <vector>

namespace vera {

/// An area that is to be painted as a field says.
struct PaintedRegion {
    FilledOutline outline;         ///< its names and seams
    std::vector<BorderRing> rings; ///< where the field holds
    std::vector<BorderRing> below; ///< where it goes on below what is painted later

    /// Else what lies behind would come through where several of its parts meet in a pixel.
    bool lies_on_underlay = true;
};

/// Adds all the rings, whose sides lie on these curves, to the region's outline.
void add_rings(PaintedRegion& region, std::span<const DrawingEllipse> curves);

/// How well a paint is to agree with its field: at each place with what the field is there, or not
/// farther than `within` away; at_border holds where the border of the region is nearer than half a
/// pixel and colours change by more than 3 of 255 within that, as along silhouettes of curved
/// surfaces they do without bound.
struct PaintTolerance {
    double color = 1.0 / 255; ///< in any of red, green and blue, 1 for 255
    double within = 0.0003;   ///< pixels
    double at_border = 0.1;   ///< pixels
};

/// The region with a colour or gradient, or cut by lines into parts that have one each, so that
/// all agree with the field at samples of that spacing. What is less than a pixel long is not cut,
/// and may agree less; regions that small have one colour. Parts are to be painted in their order:
/// each goes on below the later ones by a pixel, and where the region lies on no underlay, all of
/// it is painted before them, in the paint that fits best. The curves are those of the rings'
/// sides. Throws Cancelled.
std::vector<FilledOutline> painted(
    PaintedRegion region,
    const ColorField& field,
    const PaintTolerance& tolerance,
    std::span<const DrawingEllipse> curves = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
