// SPDX-License-Identifier: Apache-2.0
// Places at which the colours of a region are looked at.
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/visible/border_ring.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace vera {

/// Smallest rectangle along the axes; empty where nothing was added.
struct Extent {
    DrawingPoint least = {
        std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    DrawingPoint most = {
        -std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

    /// The longer side.
    double length() const;
};

Extent extent_of(const std::vector<BorderRing>& rings);

double area_of(const std::vector<BorderRing>& rings);

/// How far apart the points are at which the paint of a region of that length, along x or y, and
/// area is compared with its field: 6 pixels or less, a quarter of the length of small regions and
/// half the width of narrow ones, but no less than a 64th of the length of narrow ones and a 128th
/// of that of large ones.
double sample_spacing(double length, double area);

/// Points of the areas: the corners, and of borders and areas points so far apart at most.
std::vector<DrawingPoint> sample_points(const std::vector<BorderRing>& rings, double spacing);

/// Points inside the areas, one for each square of that size, about, but neither in its rows nor in
/// its columns: colours often change along one of these alone. Others in each round.
std::vector<DrawingPoint>
scattered_points(const std::vector<BorderRing>& rings, double spacing, std::uint64_t round);

} // namespace vera
