// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/visible/map_segments.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vera {

/// A map and the background round it, as triangles that meet side by side.
struct MapTriangulation {
    /// The first two and the last two are corners of a square a step larger than the picture.
    std::vector<MapPoint> points;
    std::vector<std::array<std::uint32_t, 3>> triangles; ///< of points, to the left
    std::vector<std::uint32_t> regions;                  ///< of each triangle, or no_region
    std::uint64_t steps = 0;                             ///< points that were compared with lines
};

/// By a sweep from the left that joins each point with all that it sees of the points before it, in
/// the gaps between the borders beside it (Hertel and Mehlhorn 1983): O(m log m). Throws Cancelled,
/// and CrossingBorders.
MapTriangulation triangulation(const MapSegments& segments, const CancelFlag* cancel = nullptr);

} // namespace vera
