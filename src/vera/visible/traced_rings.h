// SPDX-License-Identifier: Apache-2.0
// The rings of a map, found by walking the ways along pieces. In parts that threads share, since
// what they are found with takes as much room as they.
#pragma once

#include "vera/base/parallel.h"
#include "vera/visible/visible_map.h"
#include "vera/visible/ways.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// The rings of some regions, as in a VisibleMap that has no others.
struct TracedRings {
    struct Ring {
        std::uint32_t region = 0;
        std::uint32_t first = 0; ///< in ring_vertices; it ends where the next one begins
    };

    std::vector<Ring> rings;
    std::vector<std::uint32_t> ring_vertices;
    std::vector<std::uint32_t> ring_across; ///< empty where that is not asked for
    std::vector<std::size_t> joined_sides;
    std::vector<std::uint32_t> places; ///< of the rings in the whole map

    std::size_t count_of(std::size_t ring) const {
        const std::size_t end =
            ring + 1 < rings.size() ? rings[ring + 1].first : ring_vertices.size();
        return end - rings[ring].first;
    }
};

/// The rings of all regions, of which there are so many, those of each in one part. next[i] is the
/// way that follows way i on the border of its region. Throws Cancelled.
std::vector<TracedRings> traced_rings(
    Ways ways,
    std::size_t regions,
    RingDetail detail,
    std::vector<std::uint32_t> next,
    const Progress& progress,
    const CancelFlag* cancel);

/// Puts the rings of all parts into the map, whose regions are there already.
void join_rings(std::vector<TracedRings> parts, RingDetail detail, VisibleMap& map);

} // namespace vera
