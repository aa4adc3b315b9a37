// SPDX-License-Identifier: Apache-2.0
// The first of n rectangles that a ray meets, by point location (VERA 3.3.1, proposition 2):
// O(log^3 n) steps a ray, and O(n^3 polylog n) of space.
//
// Seen along the y axis, the ray's line rises until it meets the end of a rectangle's side
// (dual_arrangement.h); it passes the same sides as before (pivot_ranges.h). Seen along the x axis
// it does so as well. Of lines that meet both these ends only two slopes are left to tell, and each
// rectangle is met for a range of the one and a range of the other: it is a rectangle in the plane
// of slopes. So for each of the 4 n^2 pairs of ends there is a structure that tells which of n
// rectangles hold a point (stabbing_tree.h).
#pragma once

#include "vera/theory/side_projection.h"
#include "vera/theory/stabbing_tree.h"

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace vera {

class DualPairs {
public:
    /// When structures of pairs are built: all at once, or each when the first ray asks for it.
    enum class Building { all, when_asked };

    /// Takes O(n^3 log^3 n), or O(n^2 log n) and the rest later. Throws std::invalid_argument as
    /// RectanglesByZ does, std::runtime_error where the memory that is available does not suffice,
    /// by a sample of the pairs, and Cancelled.
    explicit DualPairs(
        std::span<const IsoRectangle> rectangles,
        Stabbing kind = Stabbing::from_a_rank,
        Building building = Building::all,
        const Progress& progress = {},
        const CancelFlag* cancel = nullptr);

    /// As brute_force_first_rectangle(), and throws likewise. Only of structures for rays. May be
    /// asked from many threads.
    std::optional<std::uint32_t>
    first_rectangle(const WholeRay& ray, DualCounts* counts = nullptr) const;

    /// As brute_force_lowest_rectangle(), and throws likewise. May be asked from many threads.
    std::optional<std::uint32_t>
    lowest_rectangle(const WholeRay& ray, DualCounts* counts = nullptr) const;

    /// How many pairs of ends there are, and of how many of them the structure is built.
    std::size_t pair_count() const { return trees_.size(); }

    std::size_t built_count() const;

    /// What it takes of memory by now.
    std::size_t bytes() const;

    /// At most so much, in bytes, whatever the rectangles are, when all is built; without what the
    /// allocator takes for itself. Scattered rectangles take a tenth of it or less.
    static double bytes_forecast(std::size_t rectangles, Stabbing kind);

private:
    /// Where a ray is to be looked for.
    struct Place {
        const StabbingTree& tree;
        PivotPlace across;
        PivotPlace along;
    };

    std::optional<Place> place_of(const WholeRay& ray, DualCounts& counts) const;
    const StabbingTree& tree(std::uint32_t line_x, std::uint32_t line_y) const;
    double sampled_bytes_of_trees() const;
    StabbingTree built(std::uint32_t line_x, std::uint32_t line_y) const;

    Stabbing kind_;
    RectanglesByZ order_;
    SideProjection along_y_;   ///< the side view that shows x
    SideProjection along_x_;   ///< the one that shows y
    mutable std::mutex mutex_; ///< of what is built when it is asked for
    mutable std::vector<std::unique_ptr<const StabbingTree>> trees_;
};

/// The reference for lines: the number of the rectangle with the smallest z that the ray's line
/// meets, before its origin or behind it, of several in one plane the smallest number.
std::optional<std::uint32_t>
brute_force_lowest_rectangle(std::span<const IsoRectangle> rectangles, const WholeRay& ray);

} // namespace vera
