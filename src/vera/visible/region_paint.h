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
};

/// Adds all the rings, whose sides lie on these curves, to the region's outline.
void add_rings(PaintedRegion& region, std::span<const DrawingEllipse> curves);

/// How well a paint is to agree with its field: at each place with what the field is there, or not
/// farther than `within` away.
struct PaintTolerance {
    double color = 1.0 / 255; ///< in any of red, green and blue, 1 for 255
    double within = 0.1;      ///< pixels
};

/// How far apart the points are at which the paint of a region of that length, along x or y, and
/// area is compared with its field: 6 pixels or less, a quarter of the length of small regions and
/// half the width of narrow ones, but no less than a 64th of the length of narrow ones and a 128th
/// of that of large ones.
double sample_spacing(double length, double area);

/// Points of the areas: the corners, and of borders and areas points so far apart at most.
std::vector<DrawingPoint> sample_points(const std::vector<BorderRing>& rings, double spacing);

/// The region with a colour or gradient, or cut by lines into parts that have one each, so that
/// all agree with the field at samples of that spacing. What is less than a pixel long is not cut,
/// and may agree less; regions that small have one colour. Parts are to be painted in their order:
/// each goes on below the later ones by a pixel. The curves are those of the rings' sides. Throws
/// Cancelled.
std::vector<FilledOutline> painted(
    PaintedRegion region,
    const ColorField& field,
    const PaintTolerance& tolerance,
    std::span<const DrawingEllipse> curves = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
