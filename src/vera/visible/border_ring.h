// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/visible/outline_curves.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// A point of the border of an area, and what leads on from it to the next one: a straight side, or
/// one along a curve, of which the straight one is a chord.
struct BorderPoint : DrawingPoint {
    std::uint32_t curve = no_curve; ///< see OutlineCurves
    bool is_node = false;           ///< no arc goes on through it: other areas' borders end there

    BorderPoint() = default;

    BorderPoint(double to_the_right, double down)
        : DrawingPoint{to_the_right, down} {}

    BorderPoint(DrawingPoint place, std::uint32_t on_curve = no_curve, bool node = false)
        : DrawingPoint(place)
        , curve(on_curve)
        , is_node(node) {}
};

/// A closed way round an area or a hole in it.
using BorderRing = std::vector<BorderPoint>;

/// Curves of borders, each with one a trace smaller and one a trace larger: what goes on below what
/// is beyond a border reaches back by that, since the arcs of either side of it are rounded by
/// themselves.
class BorderCurves {
public:
    BorderCurves() = default;
    explicit BorderCurves(std::span<const DrawingEllipse> curves);

    std::uint32_t smaller(std::uint32_t curve) const { return curve + count_; }

    std::uint32_t larger(std::uint32_t curve) const { return curve + 2 * count_; }

    std::span<const DrawingEllipse> all() const { return curves_; }

private:
    std::uint32_t count_ = 0;
    std::vector<DrawingEllipse> curves_; ///< as they are, the smaller and the larger ones
};

/// Adds the ring to the outline: sides along one curve that follow each other are one arc, whose
/// ends are on the curve. Without one that leads to and fro on one curve, and encloses nothing.
void add_ring(
    const BorderRing& ring, std::span<const DrawingEllipse> curves, FilledOutline& outline);

} // namespace vera
