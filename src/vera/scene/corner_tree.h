// SPDX-License-Identifier: Apache-2.0
// A tree of a polygon's corners, each node with the box of its own (a k-d tree: Bentley,
// Multidimensional binary search trees used for associative searching, 1975): whether a triangle
// holds one is known when the few boxes that it reaches into are looked at, however wide it is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera::detail {

struct FlatPoint {
    double x = 0;
    double y = 0;

    friend bool operator==(const FlatPoint&, const FlatPoint&) = default;
};

/// Positive where a, b, c turn to the left. Its rounded value never falls, or never rises, with
/// either coordinate of c: so that it is largest at a corner of a box, rounding and all.
inline double turn(FlatPoint a, FlatPoint b, FlatPoint c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

class CornerTree {
public:
    /// The points must outlive this.
    explicit CornerTree(std::span<const FlatPoint> points)
        : points_(points) {}

    /// Of these corners in place of others, by their numbers.
    void build(std::vector<std::uint32_t> corners);

    /// How many it was made of.
    std::size_t size() const { return corners_.size(); }

    /// Whether is_meant(corner) is true of one that lies in the triangle, by the signs of turn(),
    /// and within its reach from left to right. Each node and each corner that is looked at is a
    /// step; true as well where there are none left.
    template <typename IsMeant>
    bool is_any_in(
        const std::array<FlatPoint, 3>& triangle,
        const IsMeant& is_meant,
        std::size_t& steps_left) const {
        return !corners_.empty() && is_any_in(0, triangle, is_meant, steps_left);
    }

private:
    static constexpr std::size_t most_of_a_leaf = 8;

    struct Node {
        FlatPoint low;
        FlatPoint high;
        std::uint32_t first = 0; ///< of corners_
        std::uint32_t end = 0;
        std::uint32_t second_child = 0; ///< the first one follows; 0: it is a leaf
    };

    void add_node(std::uint32_t first, std::uint32_t end);
    static bool may_meet(const Node& node, const std::array<FlatPoint, 3>& triangle);

    template <typename IsMeant>
    bool is_any_in(
        std::uint32_t number,
        const std::array<FlatPoint, 3>& triangle,
        const IsMeant& is_meant,
        std::size_t& steps_left) const {
        const Node& node = nodes_[number];
        const std::size_t steps = node.second_child == 0 ? 1 + node.end - node.first : 1;
        if (steps_left < steps) {
            steps_left = 0;
            return true;
        }
        steps_left -= steps;
        if (!may_meet(node, triangle))
            return false;
        if (node.second_child != 0)
            return is_any_in(number + 1, triangle, is_meant, steps_left)
                || is_any_in(node.second_child, triangle, is_meant, steps_left);
        for (std::uint32_t i = node.first; i < node.end; ++i)
            if (is_meant(corners_[i]) && is_in(triangle, points_[corners_[i]]))
                return true;
        return false;
    }

    static bool is_in(const std::array<FlatPoint, 3>& triangle, FlatPoint point);

    std::span<const FlatPoint> points_;
    std::vector<std::uint32_t> corners_;
    std::vector<Node> nodes_;
};

} // namespace vera::detail
