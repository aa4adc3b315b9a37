// SPDX-License-Identifier: Apache-2.0
// Convex hulls of points with whole coordinates, exactly, and how far they reach along a normal.
#pragma once

#include "vera/theory/plane_strip.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// The numbers of the hull's vertices, without those on its sides and one of each equal ones: in
/// two chains, both from the leftmost point to the rightmost one. Of points above each other the
/// lower one counts as farther left.
struct PlaneHull {
    std::vector<std::uint32_t> below;
    std::vector<std::uint32_t> above;
};

/// Of the points with these numbers; there is one at least. Takes O(n log n).
PlaneHull hull_of(std::span<const PlanePoint> points, std::span<const std::uint32_t> numbers);

/// Of all that two hulls go round.
PlaneHull
hull_of(std::span<const PlanePoint> points, const PlaneHull& first, const PlaneHull& second);

/// The least and the largest dot(normal, p) of the points p of a hull, and how many of its vertices
/// were looked at.
struct HullExtent {
    std::int64_t lowest = 0;
    std::int64_t highest = 0;
    std::uint64_t vertices = 0;
};

/// Along either chain the product falls and then rises, or the other way round. Takes as many steps
/// as the logarithm of the vertices.
HullExtent extent_along(
    PlaneDirection normal,
    std::span<const PlanePoint> points,
    std::span<const std::uint32_t> below,
    std::span<const std::uint32_t> above);

} // namespace vera
