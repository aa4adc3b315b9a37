// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/point_boxes.h"

#include <algorithm>
#include <numeric>

namespace vera {

namespace {

constexpr std::uint32_t leaf_size = 16;

bool overlap(const Box3& a, const Box3& b) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (a.upper[axis] < b.lower[axis] || b.upper[axis] < a.lower[axis])
            return false;
    return true;
}

} // namespace

PointBoxes::PointBoxes(std::span<const Vec3> points)
    : points_(points)
    , numbers_(points.size()) {
    std::iota(numbers_.begin(), numbers_.end(), std::uint32_t{0});
    if (!numbers_.empty())
        add_node(0, static_cast<std::uint32_t>(numbers_.size()));
}

void PointBoxes::add_node(std::uint32_t first, std::uint32_t last) {
    const std::size_t number = nodes_.size();
    Node node = {{}, first, last, 0};
    for (std::uint32_t i = first; i < last; ++i)
        node.box = grown(node.box, points_[numbers_[i]]);
    nodes_.push_back(node);
    if (last - first <= leaf_size || node.box.lower == node.box.upper)
        return;
    const std::size_t axis = longest_axis(extent(node.box));
    const std::uint32_t middle = first + (last - first) / 2;
    const auto place = [&](std::uint32_t i) {
        return numbers_.begin() + static_cast<std::ptrdiff_t>(i);
    };
    std::nth_element(
        place(first), place(middle), place(last), [&](std::uint32_t a, std::uint32_t b) {
            return points_[a][axis] < points_[b][axis];
        });
    add_node(first, middle);
    nodes_[number].second = static_cast<std::uint32_t>(nodes_.size());
    add_node(middle, last);
}

void PointBoxes::append_in(const Box3& box, std::vector<std::uint32_t>& numbers) const {
    std::vector<std::uint32_t> waiting;
    if (!nodes_.empty())
        waiting.push_back(0);
    while (!waiting.empty()) {
        const std::uint32_t number = waiting.back();
        waiting.pop_back();
        const Node& node = nodes_[number];
        if (!overlap(node.box, box))
            continue;
        if (node.second != 0) {
            waiting.push_back(node.second);
            waiting.push_back(number + 1);
            continue;
        }
        for (std::uint32_t i = node.first; i < node.last; ++i)
            if (contains(box, points_[numbers_[i]]))
                numbers.push_back(numbers_[i]);
    }
}

} // namespace vera
