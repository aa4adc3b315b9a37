// SPDX-License-Identifier: Apache-2.0
// Trees that divide points of the plane in two, again and again, and find those in a half-plane or
// strip. Nodes of which all points are in, or none, are taken or left as a whole; only those that
// the border parts are looked into. A node is told by the convex hull of its own points, exactly.
// So no answer depends on how points were divided: that decides how long it takes, and is another
// file's matter (conjugation_tree.h).
#pragma once

#include "vera/base/parallel.h"
#include "vera/theory/plane_strip.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vera {

/// The steps of queries, which are the same on every machine. They add up over queries.
struct StepCounts {
    std::uint64_t nodes = 0;    ///< whose hull was compared with a query
    std::uint64_t vertices = 0; ///< of hulls that were looked at for it
    std::uint64_t points = 0;   ///< or rectangles, or rays, looked at one by one
    std::uint64_t searches = 0; ///< in sorted lists
    std::uint64_t counters = 0; ///< of what nodes hold, looked at to report it, or changed
    std::uint64_t reports = 0;  ///< of a ray that trees of rays tell a rectangle; of a node's all
                                ///< at once, and so no steps

    StepCounts& operator+=(const StepCounts& more);

    /// All steps.
    std::uint64_t steps() const { return nodes + vertices + points + searches + counters; }
};

/// How the points of a node lie to a strip.
enum class Inclusion { all, none, some };

/// A node holds the points from first to last of numbers(). Their hull is two chains of its
/// vertices, below and above, both from the leftmost to the rightmost one.
struct PartitionNode {
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

/// 0, 1, 2 ... as many as that.
std::vector<std::uint32_t> all_numbers(std::size_t count);

/// Throws std::invalid_argument where a point cannot be one of a tree (require_plane_points()), and
/// std::runtime_error where such a tree of them takes more memory, in bytes, than there is.
void require_tree(
    const std::string& kind,
    std::span<const PlanePoint> points,
    std::size_t leaf_size,
    double bytes);

/// How points are divided: the root first, each node before its children, and hulls not yet known.
struct TreeShape {
    std::vector<std::uint32_t> numbers; ///< of points, those of each node in a row
    std::vector<PartitionNode> nodes;
};

/// Whether points that are equal stay in one leaf, however many they are, or are divided as others:
/// where it is not only asked which there are, but some of them come and go.
enum class EqualPoints { together, apart };

class PartitionTree {
public:
    /// No points.
    PartitionTree() = default;

    /// Of the points, which must outlive the tree, as the shape divides them. Takes O(n log^2 n).
    /// Throws Cancelled.
    PartitionTree(
        std::span<const PlanePoint> points,
        TreeShape shape,
        const Progress& progress = {},
        const CancelFlag* cancel = nullptr);

    /// How many points lie in the strip. Throws std::invalid_argument as require_plane_strip()
    /// does.
    std::size_t count(const PlaneStrip& strip, StepCounts* counts = nullptr) const;

    /// Their numbers, in ascending order: as brute_force_numbers_in(). Throws likewise.
    std::vector<std::uint32_t>
    numbers_in(const PlaneStrip& strip, StepCounts* counts = nullptr) const;

    /// The root first, and each node before its children. None where there are no points.
    std::span<const PartitionNode> nodes() const { return nodes_; }

    /// The numbers of points, those of each node in a row.
    std::span<const std::uint32_t> numbers() const { return numbers_; }

    std::span<const std::uint32_t> numbers_of(const PartitionNode& node) const {
        return numbers().subspan(node.first, node.size());
    }

    /// By the node's hull; takes as many steps as the logarithm of its vertices.
    Inclusion
    inclusion(const PartitionNode& node, const PlaneStrip& strip, StepCounts& counts) const;

    /// What the tree takes of memory, beside the points.
    std::size_t bytes() const;

private:
    void add_hulls(const Progress& progress, const CancelFlag* cancel);

    /// Calls whole(node) for nodes of which all points lie in the strip, and single(number) for
    /// others that do.
    template <typename Whole, typename Single>
    void
    search(const PlaneStrip& strip, StepCounts& counts, const Whole& whole, const Single& single)
        const;

    std::span<const PlanePoint> points_;
    std::vector<std::uint32_t> numbers_;
    std::vector<PartitionNode> nodes_;
    std::vector<std::uint32_t> hulls_; ///< numbers of points
};

/// At most so much, in bytes, takes a tree of so many points, whatever they are, where each node of
/// more than leaf_size is halved; without what the allocator takes for itself.
double halved_bytes_forecast(std::size_t count, std::size_t leaf_size);

} // namespace vera
