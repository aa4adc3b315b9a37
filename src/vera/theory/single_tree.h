// SPDX-License-Identifier: Apache-2.0
// The first rectangle that a ray meets, by one tree with four hulls at each node: what nested trees
// (nested_trees.h) are compared with. A node has the hull of its rectangles' points for each of the
// four conditions: it is left out where one of these is outside its half-plane, and no condition is
// asked about again where all are inside. Takes linear space; no bound on its steps is known, since
// a cut that halves one set of points well may do nothing for the other three.
#pragma once

#include "vera/theory/iso_rectangle.h"
#include "vera/theory/nearest_rectangle.h"
#include "vera/theory/partition_tree.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vera {

class SingleTree {
public:
    static constexpr std::size_t usual_leaf_size = 8;

    /// Copies the rectangles. Halves their points for one condition after the other, in turns, by
    /// conjugate cuts. Takes O(n log^3 n). Throws std::invalid_argument as require_rectangles()
    /// does, std::runtime_error where the memory that is available does not suffice, and Cancelled.
    explicit SingleTree(
        std::span<const IsoRectangle> rectangles,
        std::size_t leaf_size = usual_leaf_size,
        const Progress& progress = {},
        const CancelFlag* cancel = nullptr);

    /// As brute_force_first_rectangle(), and throws likewise. May be asked from many threads.
    std::optional<std::uint32_t>
    first_rectangle(const WholeRay& ray, StepCounts* counts = nullptr) const;

    /// What it takes of memory.
    std::size_t bytes() const;

    /// At most so much, in bytes, whatever the rectangles are; with what building takes for a
    /// while, and without what the allocator takes for itself.
    static double bytes_forecast(std::size_t rectangles, std::size_t leaf_size = usual_leaf_size);

private:
    friend class SingleTreeSearch;

    std::vector<IsoRectangle> rectangles_;
    std::array<std::vector<PlanePoint>, side_condition_count> points_;
    /// The same nodes of the same rectangles, each with the hulls of one condition's points.
    std::array<PartitionTree, side_condition_count> trees_;
    std::vector<NearnessOfNode> nearness_; ///< of each node
};

} // namespace vera
