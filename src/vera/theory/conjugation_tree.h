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
//
// What is in or out as a whole is told by the convex hull of the node's own points, exactly. So no
// answer depends on where the lines are; they decide how long it takes.
#pragma once

#include "vera/base/parallel.h"
#include "vera/theory/plane_strip.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// The steps of queries, which are the same on every machine. They add up over queries.
struct QueryCounts {
    std::uint64_t nodes = 0;    ///< whose hull was compared with a query
    std::uint64_t vertices = 0; ///< of hulls that were looked at for it
    std::uint64_t points = 0;   ///< or rectangles, looked at one by one
    std::uint64_t searches = 0; ///< in sorted lists
};

/// How the points of a node lie to a strip.
enum class Inclusion { all, none, some };

/// A node holds the points from first to last of numbers(). Their hull is two chains of its
/// vertices, below and above, both from the leftmost to the rightmost one.
struct ConjugationNode {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    std::uint32_t below =
        0; ///< where in the list of vertices the chains begin, and the second ends
    std::uint32_t above = 0;
    std::uint32_t hull_end = 0;
    std::uint32_t children = 0; ///< the second one; the first is the next node. None has 0

    std::uint32_t size() const { return last - first; }

    bool is_leaf() const { return children == 0; }
};

class ConjugationTree {
public:
    static constexpr std::size_t usual_leaf_size = 8;

    /// What building takes of memory, for a while, beside the tree.
    static constexpr std::size_t building_bytes_per_point = 48;

    /// No points.
    ConjugationTree() = default;

    /// Of the points, which must outlive the tree; only of those with these numbers. Nodes of at
    /// most leaf_size points are not divided, nor are equal points. Takes O(n log^3 n). The points
    /// must be as require_plane_points() has them. Throws Cancelled.
    ConjugationTree(
        std::span<const PlanePoint> points,
        std::vector<std::uint32_t> numbers,
        std::size_t leaf_size = usual_leaf_size,
        const Progress& progress = {},
        const CancelFlag* cancel = nullptr);

    /// Of all the points. Throws std::invalid_argument as require_plane_points() does, too, and
    /// std::runtime_error where the memory that is available does not suffice.
    explicit ConjugationTree(
        std::span<const PlanePoint> points,
        std::size_t leaf_size = usual_leaf_size,
        const Progress& progress = {},
        const CancelFlag* cancel = nullptr);

    /// How many points lie in the strip. Throws std::invalid_argument as require_plane_strip()
    /// does.
    std::size_t count(const PlaneStrip& strip, QueryCounts* counts = nullptr) const;

    /// Their numbers, in ascending order: as brute_force_numbers_in(). Throws likewise.
    std::vector<std::uint32_t>
    numbers_in(const PlaneStrip& strip, QueryCounts* counts = nullptr) const;

    /// The root first, and each node before its children. None where there are no points.
    std::span<const ConjugationNode> nodes() const { return nodes_; }

    /// The numbers of points, those of each node in a row.
    std::span<const std::uint32_t> numbers() const { return numbers_; }

    std::span<const std::uint32_t> numbers_of(const ConjugationNode& node) const {
        return numbers().subspan(node.first, node.size());
    }

    /// By the node's hull; takes as many steps as the logarithm of its vertices.
    Inclusion
    inclusion(const ConjugationNode& node, const PlaneStrip& strip, QueryCounts& counts) const;

    /// What the tree takes of memory, beside the points.
    std::size_t bytes() const;

    /// At most so much, in bytes, of so many points, whatever they are; without what the allocator
    /// takes for itself.
    static double bytes_forecast(std::size_t count, std::size_t leaf_size = usual_leaf_size);

private:
    friend class ConjugationTreeBuilder;

    /// Calls whole(node) for nodes of which all points lie in the strip, and single(number) for
    /// others that do.
    template <typename Whole, typename Single>
    void
    search(const PlaneStrip& strip, QueryCounts& counts, const Whole& whole, const Single& single)
        const;

    std::span<const PlanePoint> points_;
    std::vector<std::uint32_t> numbers_;
    std::vector<ConjugationNode> nodes_;
    std::vector<std::uint32_t> hulls_; ///< numbers of points
};

} // namespace vera
