// SPDX-License-Identifier: Apache-2.0
// Points of the plane in boxes, halved across x and y in turns (Bentley 1975): what a conjugation
// tree is compared with. On scattered points a half-plane crosses the root of them; along a thin
// diagonal strip nearly all.
#pragma once

#include "vera/theory/conjugation_tree.h"

namespace vera {

class KdTree {
public:
    /// Of the points, which must outlive it; nodes of at most leaf_size are not divided.
    explicit KdTree(std::span<const PlanePoint> points, std::size_t leaf_size = 1);

    /// How many points lie in the strip.
    std::size_t count(const PlaneStrip& strip, StepCounts* counts = nullptr) const;

private:
    /// The first child is the next node.
    struct Node {
        std::uint32_t first = 0; ///< in numbers_
        std::uint32_t last = 0;
        std::uint32_t second_child = 0; ///< none has 0
        PlanePoint lowest;              ///< the corners of the box round its points
        PlanePoint highest;
    };

    std::uint32_t build(std::uint32_t first, std::uint32_t last, bool across_x);
    std::size_t count_below(std::uint32_t node, const PlaneStrip& strip, StepCounts& counts) const;

    std::span<const PlanePoint> points_;
    std::size_t leaf_size_;
    std::vector<std::uint32_t> numbers_;
    std::vector<Node> nodes_;
};

} // namespace vera
