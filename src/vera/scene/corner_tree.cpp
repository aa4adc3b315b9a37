// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/corner_tree.h"

#include <algorithm>
#include <utility>

namespace vera::detail {

void CornerTree::build(std::vector<std::uint32_t> corners) {
    corners_ = std::move(corners);
    nodes_.clear();
    if (!corners_.empty())
        add_node(0, static_cast<std::uint32_t>(corners_.size()));
}

void CornerTree::add_node(std::uint32_t first, std::uint32_t end) {
    Node node = {points_[corners_[first]], points_[corners_[first]], first, end};
    for (std::uint32_t i = first; i < end; ++i) {
        const FlatPoint point = points_[corners_[i]];
        node.low = {std::min(node.low.x, point.x), std::min(node.low.y, point.y)};
        node.high = {std::max(node.high.x, point.x), std::max(node.high.y, point.y)};
    }
    const std::size_t number = nodes_.size();
    nodes_.push_back(node);
    if (end - first <= most_of_a_leaf)
        return;
    // By places, then by numbers: each half has the same corners whatever sorts them.
    const bool is_wide = node.high.x - node.low.x >= node.high.y - node.low.y;
    const auto key = [&](std::uint32_t corner) {
        return std::pair(is_wide ? points_[corner].x : points_[corner].y, corner);
    };
    const std::uint32_t middle = first + (end - first) / 2;
    std::nth_element(
        corners_.begin() + first,
        corners_.begin() + middle,
        corners_.begin() + end,
        [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    add_node(first, middle);
    nodes_[number].second_child = static_cast<std::uint32_t>(nodes_.size());
    add_node(middle, end);
}

bool CornerTree::may_meet(const Node& node, const std::array<FlatPoint, 3>& triangle) {
    const auto [least, most] = std::minmax({triangle[0].x, triangle[1].x, triangle[2].x});
    if (node.low.x > most || node.high.x < least)
        return false;
    for (std::size_t i = 0; i < 3; ++i) {
        const FlatPoint from = triangle[i];
        const FlatPoint to = triangle[(i + 1) % 3];
        const FlatPoint leftmost = {
            to.y - from.y > 0 ? node.low.x : node.high.x,
            to.x - from.x > 0 ? node.high.y : node.low.y};
        if (turn(from, to, leftmost) < 0)
            return false;
    }
    return true;
}

bool CornerTree::is_in(const std::array<FlatPoint, 3>& triangle, FlatPoint point) {
    const auto& [a, b, c] = triangle;
    return point.x >= std::min({a.x, b.x, c.x}) && point.x <= std::max({a.x, b.x, c.x})
        && turn(a, b, point) >= 0 && turn(b, c, point) >= 0 && turn(c, a, point) >= 0;
}

} // namespace vera::detail
