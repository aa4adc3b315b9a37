// SPDX-License-Identifier: Apache-2.0
// Those of m rays that a rectangle meets, by two nested conjugation trees (VERA 3.3.2, proposition
// 3; the nesting is that of Dobkin and Edelsbrunner 1984): O(m^0.695 polylog m) steps a rectangle,
// beside those that tell the rays, and O(m log m) of space.
//
// A rectangle meets a ray where two points of the ray lie in two strips (sloped_ray.h). A tree of
// the first points names nodes of which all rays meet the condition of x; each node has a tree of
// its own, of the second points of the same rays, which names nodes of which all rays are met. A
// strip has two borders, and so parts at most twice as many nodes as a half-plane does.
//
// Trees end at nodes of few rays, which have no trees either: what happens there is for the visitor
// of a query to say. Rays may be looked at one by one; where `few` is large, the trees are those of
// the paper cut from above at some level, and their ends may have structures of their own
// (proposition 5).
#pragma once

#include "vera/theory/partition_tree.h"
#include "vera/theory/sloped_ray.h"
#include "vera/theory/tree_kind.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace vera {

/// A tree of rays, by one of their two points.
struct RayPointTree {
    PartitionTree tree;           ///< its points' numbers are those of rays
    std::uint32_t first_node = 0; ///< the number of its root among the nodes of all trees

    /// Of the outer tree: where each ray stands among the tree's numbers. Of the inner tree of a
    /// node: the same of the ray that stands at each place of the node, from the node's first on.
    std::vector<std::uint32_t> places;

    /// Of the outer tree: those of its nodes of more than few rays; nothing for others.
    std::vector<std::unique_ptr<RayPointTree>> inner;
};

/// A node of one of the trees.
struct RayTreeNode {
    const RayPointTree* of = nullptr;
    std::uint32_t index = 0; ///< in its tree

    const PartitionNode& node() const { return of->tree.nodes()[index]; }

    std::span<const std::uint32_t> rays() const { return of->tree.numbers_of(node()); }

    /// Among the nodes of all trees.
    std::uint32_t number() const { return of->first_node + index; }
};

class RayTrees {
public:
    static constexpr std::size_t usual_few = 32;

    /// Nodes of at most few rays end the trees; copies the rays. Takes O(m log^4 m). Throws
    /// std::invalid_argument as require_sloped_rays() does, std::runtime_error where the memory
    /// that is available does not suffice, and Cancelled.
    explicit RayTrees(
        std::span<const SlopedRay> rays,
        std::size_t few = usual_few,
        const Progress& progress = {},
        const CancelFlag* cancel = nullptr,
        TreeKind kind = TreeKind::conjugation);

    /// The numbers of all rays that the rectangle meets, whatever lies before it, in ascending
    /// order: as brute_force_rays_met(). Looks at each ray whose line is met, also where that
    /// begins behind the rectangle. Throws std::invalid_argument as require_rectangles() does.
    std::vector<std::uint32_t>
    rays_met(const IsoRectangle& rectangle, StepCounts* counts = nullptr) const;

    /// Calls, for nodes that have no ray in common and together have all whose lines are met,
    ///
    ///     visitor.enters(node)     for every node before it is looked at; where it returns false,
    ///                              the node is left out;
    ///     visitor.met(node)        where the lines of all its rays are met;
    ///     visitor.open_in_y(node)  at the end of the trees: all are where x must be;
    ///     visitor.open(node)       at the end of the trees: nothing is known of its rays.
    ///
    /// The node of open() is always one of the outer tree.
    template <typename Visitor>
    void visit(const IsoRectangle& rectangle, StepCounts& counts, Visitor&& visitor) const {
        if (!rays_.empty())
            visit_outer(
                Strips{x_strip(rectangle), y_strip(rectangle)}, {&outer_, 0}, counts, visitor);
    }

    /// Calls use(node) for each node that holds the ray: O(log^2 m).
    template <typename Use>
    void for_each_node_of(std::uint32_t ray, const Use& use) const {
        const std::uint32_t place = outer_.places[ray];
        walk(outer_, place, [&](RayTreeNode node) {
            use(node);
            if (const RayPointTree* inner = outer_.inner[node.index].get())
                walk(*inner, inner->places[place - node.node().first], use);
        });
    }

    std::span<const SlopedRay> rays() const { return rays_; }

    /// Of all trees together. Each has a number below it.
    std::size_t node_count() const { return node_count_; }

    /// What it takes of memory.
    std::size_t bytes() const;

    /// At most so much, in bytes, whatever the rays are, of optimal trees about so much; with what
    /// building and LiveRays take, and without what the allocator takes for itself.
    static double bytes_forecast(
        std::size_t rays, std::size_t few = usual_few, TreeKind kind = TreeKind::conjugation);

private:
    struct Strips {
        PlaneStrip x;
        PlaneStrip y;
    };

    template <typename Visitor>
    void visit_outer(
        const Strips& strips, RayTreeNode node, StepCounts& counts, const Visitor& visitor) const {
        if (!visitor.enters(node))
            return;
        const PartitionNode& held = node.node();
        switch (outer_.tree.inclusion(held, strips.x, counts)) {
        case Inclusion::none:
            return;
        case Inclusion::all:
            if (const RayPointTree* inner = outer_.inner[node.index].get())
                visit_inner(strips.y, {inner, 0}, counts, visitor);
            else
                visitor.open_in_y(node);
            return;
        case Inclusion::some:
            if (held.is_leaf()) {
                visitor.open(node);
            } else {
                visit_outer(strips, {node.of, node.index + 1}, counts, visitor);
                visit_outer(strips, {node.of, held.children}, counts, visitor);
            }
        }
    }

    template <typename Visitor>
    void visit_inner(
        const PlaneStrip& strip,
        RayTreeNode node,
        StepCounts& counts,
        const Visitor& visitor) const {
        if (!visitor.enters(node))
            return;
        const PartitionNode& held = node.node();
        const Inclusion included = node.of->tree.inclusion(held, strip, counts);
        if (included == Inclusion::all) {
            visitor.met(node);
        } else if (included == Inclusion::some && held.is_leaf()) {
            visitor.open_in_y(node);
        } else if (included == Inclusion::some) {
            visit_inner(strip, {node.of, node.index + 1}, counts, visitor);
            visit_inner(strip, {node.of, held.children}, counts, visitor);
        }
    }

    /// From the root of a tree down to the leaf with what stands at the place.
    template <typename Use>
    static void walk(const RayPointTree& tree, std::uint32_t place, const Use& use) {
        std::uint32_t index = 0;
        for (;;) {
            use(RayTreeNode{&tree, index});
            const PartitionNode& node = tree.tree.nodes()[index];
            if (node.is_leaf())
                return;
            index = place < tree.tree.nodes()[node.children].first ? index + 1 : node.children;
        }
    }

    friend class RayTreesBuilder;

    std::vector<SlopedRay> rays_;
    std::vector<PlanePoint> x_points_;
    std::vector<PlanePoint> y_points_;
    RayPointTree outer_;
    std::size_t few_ = 0;
    TreeKind kind_ = TreeKind::conjugation;
    std::size_t node_count_ = 0;
};

/// Which of the rays of some trees are live, and how many in each node, so that queries leave out
/// nodes where none is.
class LiveRays {
public:
    /// None is live. The trees must outlive it.
    explicit LiveRays(const RayTrees& trees);

    /// The ray is not live, and now it is; or the other way round. O(log^2 m).
    void add(std::uint32_t ray, StepCounts& counts);
    void remove(std::uint32_t ray, StepCounts& counts);

    std::size_t count() const { return count_; }

    std::uint32_t count_in(RayTreeNode node) const { return counts_[node.number()]; }

    bool is_live(std::uint32_t ray) const { return live_[ray] != 0; }

    /// Appends the live ones of the node's rays: O(log m) each.
    void append_of(RayTreeNode node, std::vector<std::uint32_t>& rays, StepCounts& counts) const;

    /// Appends the live rays whose lines the rectangle meets, in no order that matters. The
    /// rectangle must be as require_rectangles() has it.
    void append_met(
        const IsoRectangle& rectangle, std::vector<std::uint32_t>& rays, StepCounts& counts) const;

private:
    const RayTrees& trees_;
    std::vector<std::uint32_t> counts_; ///< for each node of all trees
    std::vector<std::uint8_t> live_;    ///< for each ray
    std::size_t count_ = 0;
};

} // namespace vera
