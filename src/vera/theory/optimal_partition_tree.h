// SPDX-License-Identifier: Apache-2.0
// A partition tree of O(sqrt n) nodes a query, but for a logarithm: what became of the conjugation
// tree (after Chan 2012, "Optimal partition trees"; Matousek 1992 on test lines).
//
// Some lines stand for all queries. Points are divided among cells, and on each level every cell
// into about b parts: by some of the test lines that cross it, drawn at random. Where these hardly
// cross each other within the cell they make strips, and where they do a mesh; either way a part is
// crossed by about one in sqrt(b) of them. What remains too large is halved. Then each line becomes
// heavier with each part that it crosses, and lines are drawn by their weights: those that were
// unlucky in some cells are followed in others, and so not only the average but each line crosses
// O(sqrt t) of t cells. That is proven for a b that is large enough; here it is one that pays.
//
// The test lines go through two each of s points that are drawn at random. They are the corners of
// the faces of these points' dual arrangement. Any line lies in one of the faces, and there in a
// triangle of three corners; it crosses a cell that none of the three does only where the cell has
// one of the O(n/s log s) points whose duals meet the triangle. With as many test lines as leaves,
// that adds O(sqrt n log n) nodes.
#pragma once

#include "vera/theory/partition_tree.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

class OptimalPartitionTree : public PartitionTree {
public:
    static constexpr std::size_t usual_leaf_size = 8;

    /// In how many nodes a point is, for each of a tree of halves: in 1.3, and seldom in more than
    /// this.
    static constexpr double depth_factor = 1.5;

    /// Of the points, which must outlive the tree; only of those with these numbers. Nodes of at
    /// most leaf_size points are not divided. Takes O(n^1.5) at most where leaves are of one point,
    /// and O(n log n + (n/leaf_size)^1.5). The points must be as require_plane_points() has them.
    /// Throws Cancelled.
    OptimalPartitionTree(
        std::span<const PlanePoint> points,
        std::vector<std::uint32_t> numbers,
        std::size_t leaf_size = usual_leaf_size,
        const Progress& progress = {},
        const CancelFlag* cancel = nullptr,
        EqualPoints equal = EqualPoints::together);

    /// Of all the points. Throws std::invalid_argument as require_plane_points() does, too, and
    /// std::runtime_error where the memory that is available does not suffice.
    explicit OptimalPartitionTree(
        std::span<const PlanePoint> points,
        std::size_t leaf_size = usual_leaf_size,
        const Progress& progress = {},
        const CancelFlag* cancel = nullptr);

    /// What it takes of memory, in bytes, of so many points, where all of them are vertices of
    /// hulls.
    static double bytes_forecast(std::size_t count, std::size_t leaf_size = usual_leaf_size);

    /// What building takes for a while beside the tree.
    static double building_bytes(std::size_t count, std::size_t leaf_size = usual_leaf_size);
};

} // namespace vera
