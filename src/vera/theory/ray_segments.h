// SPDX-License-Identifier: Apache-2.0
// Those of m rays that a rectangle meets, by a segment tree along z with range trees at its nodes
// (VERA 3.3.2, figure 3d, proposition 4): O(log^4 m) steps a rectangle, beside those that tell the
// rays, for O(m^2 log^2 m) of space.
//
// Seen along y, rays are lines in the plane of x and z, and seen along x in that of y and z. Each
// ray is cut where it crosses another in either view: into O(m) segments, O(m^2) in all. The
// segment tree names O(log m) nodes for each, ranges of z that the segment spans. Of rays that span
// a node's range no two change places within it, neither in x nor in y. So a range tree that is
// made once, over their order in x, tells for all z of the node which of them lie in a rectangle.
//
// As planes of rectangles lie at whole z, rays change places for them at the first whole z from
// their crossing on: the cuts are there, and nothing is rounded.
#pragma once

#include "vera/base/parallel.h"
#include "vera/theory/partition_tree.h"
#include "vera/theory/sloped_ray.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

class RaySegments {
public:
    /// Copies the rays. Takes O(m^2 log^2 m). Throws std::invalid_argument as require_sloped_rays()
    /// does, std::runtime_error where the memory that is available does not suffice, which is known
    /// after O(m^2 log m) already, and Cancelled.
    explicit RaySegments(
        std::span<const SlopedRay> rays,
        const Progress& progress = {},
        const CancelFlag* cancel = nullptr);

    /// The numbers of the rays that the rectangle meets, whatever lies before it, in ascending
    /// order: as brute_force_rays_met(). Counts the rays whose places are compared with borders as
    /// points. Throws std::invalid_argument as require_rectangles() does.
    std::vector<std::uint32_t>
    rays_met(const IsoRectangle& rectangle, StepCounts* counts = nullptr) const;

    /// Into how many the rays are cut.
    std::size_t segment_count() const { return segment_count_; }

    /// In how many nodes segments are, all together.
    std::size_t entry_count() const { return entry_count_; }

    /// How many nodes there are from a leaf of the segment tree to its root.
    std::size_t height() const;

    /// What it takes of memory.
    std::size_t bytes() const;

    /// What it will take, in bytes, as nearly as is known without making it: takes O(m^2 log m)
    /// time. Throws as the constructor does where not even that can be asked.
    static double
    bytes_forecast(std::span<const SlopedRay> rays, const CancelFlag* cancel = nullptr);

private:
    friend class RaySegmentsBuilder;

    /// Nothing but what the constructor makes.
    RaySegments() = default;

    /// Appends those of the rays of a node that lie in the rectangle.
    void search(
        std::size_t node,
        const IsoRectangle& rectangle,
        std::vector<std::uint32_t>& found,
        StepCounts& counts) const;

    std::vector<SlopedRay> rays_;
    std::vector<std::int32_t> starts_;   ///< of the leaves' ranges of z; each ends before the next
    std::size_t leaves_ = 0;             ///< at least as many, a power of two
    std::vector<std::uint32_t> counts_;  ///< of each node's rays; node 1 is the root, and the
                                         ///< children of node i are 2 i and 2 i + 1
    std::vector<std::uint64_t> firsts_;  ///< of each node's entries
    std::vector<std::uint32_t> entries_; ///< of a node with k rays: their numbers in their order
                                         ///< along x, then the same in pairs that are sorted along
                                         ///< y, in fours, ...
    std::size_t segment_count_ = 0;
    std::size_t entry_count_ = 0;
};

} // namespace vera
