// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace vera {

/// The steps of a plane sweep, which are the same on every machine.
struct PlaneSweepCounts {
    std::uint64_t segments = 0;
    std::uint64_t corners = 0;            ///< points at which segments begin or end
    std::uint64_t crossings = 0;          ///< other points at which segments meet
    std::uint64_t edges = 0;              ///< of the connection graph, without drains
    std::uint64_t drains = 0;             ///< that are no part of a segment
    std::uint64_t queued = 0;             ///< crossings that were found, some more than once
    std::uint64_t orientations = 0;       ///< asked: on which side of a segment is a point
    std::uint64_t exact_orientations = 0; ///< of these, where doubles did not suffice
    std::uint64_t comparisons = 0;        ///< of points
    std::uint64_t exact_comparisons = 0;
    std::uint64_t insertions = 0; ///< into inclusion sets
    std::uint64_t moved = 0; ///< entries of inclusion sets, to make place or close a gap: no step
                             ///< of the bound, which balanced trees would keep
    std::uint64_t depth_orders = 0; ///< of two triangles
    std::uint64_t largest_set = 0;
    std::uint64_t looked_at = 0;  ///< edges that no triangle hides at first sight
    std::uint64_t candidates = 0; ///< triangles above and below these, summed up: as moved
    std::uint64_t visible_edges = 0;

    /// Of the bound: without entries of sets that are moved.
    std::uint64_t steps() const {
        return orientations + comparisons + queued + insertions + depth_orders;
    }
};

} // namespace vera
