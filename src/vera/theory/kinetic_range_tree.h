// SPDX-License-Identifier: Apache-2.0
// The rays that meet a rectangle of the plane across the z axis, while that plane moves
// (VERA 3.3.2, "semidynamical range tree"). The rays are kept in the order of x and in that of y,
// and each order changes where two rays cross. A binary tree stands over the places of the order of
// x. Each of its nodes has its rays in the order of y, in a search tree. So a rectangle is answered
// by O(log m) nodes, and in each by O(log m) comparisons.
//
// Two neighbours in x that cross change the nodes that have one of them; two neighbours in y those
// that have both.
//
// Rays have a place from the beginning, with their line extended backwards, and are told from when
// they are added. A ray that is removed leaves its place empty.
#pragma once

#include "vera/theory/kinetic_order.h"
#include "vera/theory/sloped_ray.h"

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <set>
#include <span>
#include <vector>

namespace vera {

/// The steps of sweeps, which are the same on every machine. They add up. Without what it takes to
/// sort rays and rectangles before a sweep moves: O(m log m + n log n).
struct SweepCounts {
    std::uint64_t pairs = 0;   ///< of rays in one sweep, which may cross in each plane: no steps
    std::uint64_t x_swaps = 0; ///< neighbours that cross, in the plane of x and z
    std::uint64_t y_swaps = 0; ///< and in that of y and z
    std::uint64_t moves = 0;   ///< of a ray into a node's order, or out of it, or within it
    std::uint64_t comparisons = 0; ///< of rays with others or with a rectangle, in nodes' orders;
                                   ///< n ceil(log2 n) where n are added, which are sorted
    std::uint64_t nodes = 0;       ///< that were looked at for rectangles
    std::uint64_t reports = 0;     ///< of a ray that meets a rectangle
    std::uint64_t rectangles = 0;  ///< that were asked for
    std::uint64_t hulls = 0;       ///< tests of a group's hull with a rectangle

    SweepCounts& operator+=(const SweepCounts& more);

    /// What happens, each in O(log^2 m) steps.
    std::uint64_t events() const { return x_swaps + y_swaps + reports + rectangles + hulls; }

    /// All steps: what a bound is compared with.
    std::uint64_t steps() const { return events() + moves + comparisons + nodes; }
};

class KineticRangeTree {
public:
    /// So many places make a leaf, in which rays are looked at one by one.
    static constexpr unsigned leaf_bits = 4;

    /// The plane is at first_z, and moves to last_z at most. Takes O(m log m). The rays must be as
    /// require_sloped_rays() has them, the zs at most largest_plane_coordinate. The counts must
    /// outlive the tree.
    KineticRangeTree(
        std::span<const SlopedRay> rays,
        std::int32_t first_z,
        std::int32_t last_z,
        SweepCounts& counts);
    KineticRangeTree(const KineticRangeTree&) = delete;
    KineticRangeTree& operator=(const KineticRangeTree&) = delete;

    /// Lets the plane pass the next crossing up to that z, in x or y. False where there is none:
    /// the orders are those at z.
    bool pass_crossing(std::int32_t z);

    /// Tells of the rays from now on. O(log^2 m) each, as all that follows; O(log m) where no other
    /// was added before: they are sorted by y, once.
    void add(std::span<const std::uint32_t> rays);

    /// It meets nothing any more. It need not have been added.
    void remove(std::uint32_t ray);

    /// Appends the rays that were added, and not removed, and that meet the rectangle, at whose z
    /// the plane must be.
    void append_met(const IsoRectangle& rectangle, std::vector<std::uint32_t>& met);

    const KineticOrder& x_order() const { return x_; }

    const KineticOrder& y_order() const { return y_; }

    /// Of the tree's nodes but the leaves, each with its places of the order of x and its rays in
    /// the order of y: calls visit(first_place, last_place, rays).
    template <typename Visitor>
    void for_each_node(const Visitor& visit) const {
        for (std::size_t level = 1; level < levels_.size(); ++level)
            for (std::size_t i = 0; i < levels_[level].size(); ++i) {
                const std::size_t size = std::size_t{1} << (leaf_bits + level);
                visit(i * size, (i + 1) * size, levels_[level][i].by_y);
            }
    }

    /// What m rays take of memory, in bytes, at most: O(m log m).
    static double bytes_forecast(std::size_t rays);

private:
    /// Where a rectangle begins in y.
    struct LowerBound {
        std::int64_t y = 0;
        std::int32_t z = 0;
    };

    /// The order of y, of rays by their places, which are right between crossings at one z, too.
    struct ByY {
        using is_transparent = void; // NOLINT(readability-identifier-naming): the library's name

        bool operator()(std::uint32_t a, std::uint32_t b) const;
        bool operator()(std::uint32_t ray, const LowerBound& bound) const;

        KineticRangeTree* tree;
    };

    using RaysByY = std::pmr::set<std::uint32_t, ByY>;

    /// Its places begin at its number times their count.
    struct Node {
        std::uint32_t first = KineticOrder::none; ///< the places of its outermost rays
        std::uint32_t last = KineticOrder::none;  ///< that are not removed
        RaysByY by_y;                             ///< of those that were added; not of leaves
    };

    void pass_in_x(const Crossing& crossing);
    void pass_in_y(const Crossing& crossing);
    void find_ends(std::uint32_t place);
    void search(std::size_t level, std::uint32_t number);
    void look_at_leaf(const Node& leaf);
    void append_in_y(const Node& node);

    std::size_t node_number(std::size_t level, std::uint32_t place) const {
        return place >> (leaf_bits + level);
    }

    /// Calls use(node) for the nodes with a search tree over a place, from the lowest on.
    template <typename Use>
    void for_each_above(std::uint32_t place, const Use& use) {
        for (std::size_t level = 1; level < levels_.size(); ++level)
            use(levels_[level][node_number(level, place)]);
    }

    std::int64_t x_at(std::uint32_t ray, std::int32_t z) const {
        return value_at(x_points_[ray], z);
    }

    std::int64_t y_at(std::uint32_t ray, std::int32_t z) const {
        return value_at(y_points_[ray], z);
    }

    std::vector<PlanePoint> x_points_;
    std::vector<PlanePoint> y_points_;
    KineticOrder x_;
    KineticOrder y_;
    SweepCounts& counts_;
    std::vector<std::uint8_t> is_added_;
    std::vector<std::uint32_t> by_y_;             ///< those that are being added
    std::pmr::monotonic_buffer_resource entries_; ///< of search trees: none is given back
    std::vector<std::vector<Node>> levels_;       ///< leaves first

    // What is in work in a query.
    IsoRectangle rectangle_;
    std::vector<std::uint32_t>* met_ = nullptr;
    std::vector<RaysByY::node_type> taken_out_;
};

} // namespace vera
