// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/visible/visible_map.h"

#include <cstdint>
#include <vector>

namespace vera {

/// What of a picture is covered, in areas that hang together.
struct CoveredAreas {
    /// Closed ways along which the area is on the left and something else on the right: sides of
    /// the map's rings, each as the place of its first vertex in ring_vertices.
    using Outline = std::vector<std::vector<std::uint32_t>>;

    std::vector<Outline> outlines;
    std::vector<std::uint32_t> of_source; ///< the area of each source that is seen
};

/// Throws Cancelled.
CoveredAreas covered_areas(
    const VisibleMap& map, const Progress& progress = {}, const CancelFlag* cancel = nullptr);

} // namespace vera
