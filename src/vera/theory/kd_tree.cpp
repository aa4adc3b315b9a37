// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/kd_tree.h"

#include <algorithm>
#include <numeric>

namespace vera {

KdTree::KdTree(std::span<const PlanePoint> points, std::size_t leaf_size)
    : points_(points)
    , leaf_size_(std::max<std::size_t>(leaf_size, 1))
    , numbers_(points.size()) {
    require_plane_points(points);
    std::iota(numbers_.begin(), numbers_.end(), 0U);
    if (!points.empty())
        build(0, static_cast<std::uint32_t>(points.size()), true);
}

std::uint32_t KdTree::build(std::uint32_t first, std::uint32_t last, bool across_x) {
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    const PlanePoint any = points_[numbers_[first]];
    Node node = {first, last, 0, any, any};
    for (std::uint32_t i = first; i < last; ++i) {
        const PlanePoint point = points_[numbers_[i]];
        node.lowest = {std::min(node.lowest.x, point.x), std::min(node.lowest.y, point.y)};
        node.highest = {std::max(node.highest.x, point.x), std::max(node.highest.y, point.y)};
    }
    nodes_.push_back(node);
    if (last - first <= leaf_size_ || node.lowest == node.highest)
        return number;
    const std::uint32_t middle = first + (last - first) / 2;
    const auto begin = numbers_.begin();
    std::nth_element(
        begin + first, begin + middle, begin + last, [&](std::uint32_t a, std::uint32_t b) {
            return across_x ? points_[a].x < points_[b].x : points_[a].y < points_[b].y;
        });
    build(first, middle, !across_x);
    nodes_[number].second_child = build(middle, last, !across_x);
    return number;
}

std::size_t
KdTree::count_below(std::uint32_t number, const PlaneStrip& strip, StepCounts& counts) const {
    const Node& node = nodes_[number];
    ++counts.nodes;
    const PlaneDirection normal = strip.normal;
    // The corners of the box that lie farthest back and farthest along the normal.
    const std::int64_t lowest =
        dot(normal,
            PlanePoint{
                normal.x >= 0 ? node.lowest.x : node.highest.x,
                normal.y >= 0 ? node.lowest.y : node.highest.y});
    const std::int64_t highest =
        dot(normal,
            PlanePoint{
                normal.x >= 0 ? node.highest.x : node.lowest.x,
                normal.y >= 0 ? node.highest.y : node.lowest.y});
    if (highest < strip.lowest || lowest > strip.highest)
        return 0;
    if (lowest >= strip.lowest && highest <= strip.highest)
        return node.last - node.first;
    if (node.second_child != 0)
        return count_below(number + 1, strip, counts)
            + count_below(node.second_child, strip, counts);
    std::size_t found = 0;
    for (std::uint32_t i = node.first; i < node.last; ++i)
        found += contains(strip, points_[numbers_[i]]) ? 1 : 0;
    counts.points += node.last - node.first;
    return found;
}

std::size_t KdTree::count(const PlaneStrip& strip, StepCounts* counts) const {
    require_plane_strip(strip);
    StepCounts steps;
    return nodes_.empty() ? 0 : count_below(0, strip, counts != nullptr ? *counts : steps);
}

} // namespace vera
