// SPDX-License-Identifier: Apache-2.0
// The conjugation tree (VERA 3.3.1, figure 3b; Edelsbrunner and Welzl 1986): n points of the plane,
// of which those in a half-plane are found by looking at O(n^0.695) nodes, in linear space.
//
// A line halves the points; one further line, a ham-sandwich cut, halves both halves; and so on
// within each of them. These two lines make four quarters, and a third line, that of a query, meets
// at most three: it can cross each of the two only once. So of a node's two children one at least
// has a child which the query takes or leaves as a whole. If V(h) counts the nodes that are looked
// at in a tree of height h,
//
//     V(h) <= V(h - 1) + V(h - 2) + 3,    V(0) = 1,    V(1) = 3,
//
// which grows as the Fibonacci numbers: as 1.618^h, and n^0.6942 as 2^h is n.
#pragma once

#include "vera/theory/partition_tree.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

using ConjugationNode = PartitionNode;

class ConjugationTree : public PartitionTree {
public:
    static constexpr std::size_t usual_leaf_size = 8;

    /// What building takes of memory, for a while, beside the tree.
    static constexpr std::size_t building_bytes_per_point = 48;

    /// No points.
    ConjugationTree() = default;

    /// Of the points, which must outlive the tree; only of those with these numbers. Nodes of at
    /// most leaf_size points are not divided. Takes O(n log^3 n). The points must be as
    /// require_plane_points() has them. Throws Cancelled.
    ConjugationTree(
        std::span<const PlanePoint> points,
        std::vector<std::uint32_t> numbers,
        std::size_t leaf_size = usual_leaf_size,
        const Progress& progress = {},
        const CancelFlag* cancel = nullptr,
        EqualPoints equal = EqualPoints::together);

    /// Of all the points. Throws std::invalid_argument as require_plane_points() does, too, and
    /// std::runtime_error where the memory that is available does not suffice.
    explicit ConjugationTree(
        std::span<const PlanePoint> points,
        std::size_t leaf_size = usual_leaf_size,
        const Progress& progress = {},
        const CancelFlag* cancel = nullptr);

    /// At most so much, in bytes, of so many points, whatever they are; without what the allocator
    /// takes for itself.
    static double bytes_forecast(std::size_t count, std::size_t leaf_size = usual_leaf_size) {
        return halved_bytes_forecast(count, leaf_size);
    }
};

} // namespace vera
