// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/kinetic_range_tree.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <utility>

namespace vera {

namespace {

std::vector<PlanePoint>
points_of(std::span<const SlopedRay> rays, PlanePoint (*point)(const SlopedRay& ray)) {
    std::vector<PlanePoint> points(rays.size());
    std::transform(rays.begin(), rays.end(), points.begin(), point);
    return points;
}

/// A node of a std::set of numbers.
constexpr std::size_t bytes_of_entry = 40;

/// Above the leaves.
std::size_t levels_of_search_trees(std::size_t rays) {
    std::size_t levels = 0;
    for (std::size_t size = std::size_t{1} << KineticRangeTree::leaf_bits; size < rays; size *= 2)
        ++levels;
    return levels;
}

/// What search trees take where all rays are added.
std::size_t bytes_of_entries(std::size_t rays) {
    return rays * levels_of_search_trees(rays) * bytes_of_entry;
}

/// A sort of so many, whichever the library takes: n ceil(log2 n).
std::uint64_t comparisons_of_sort(std::size_t count) {
    return count == 0 ? 0 : count * static_cast<std::uint64_t>(std::bit_width(count - 1));
}

/// Of so many.
std::uint64_t pairs_of(std::size_t count) {
    return count == 0 ? 0 : std::uint64_t{count} * (count - 1) / 2;
}

} // namespace

SweepCounts& SweepCounts::operator+=(const SweepCounts& more) {
    pairs += more.pairs;
    x_swaps += more.x_swaps;
    y_swaps += more.y_swaps;
    moves += more.moves;
    comparisons += more.comparisons;
    nodes += more.nodes;
    reports += more.reports;
    rectangles += more.rectangles;
    hulls += more.hulls;
    return *this;
}

bool KineticRangeTree::ByY::operator()(std::uint32_t a, std::uint32_t b) const {
    ++tree->counts_.comparisons;
    return tree->y_.place(a) < tree->y_.place(b);
}

bool KineticRangeTree::ByY::operator()(std::uint32_t ray, const LowerBound& bound) const {
    ++tree->counts_.comparisons;
    return tree->y_at(ray, bound.z) < bound.y;
}

KineticRangeTree::KineticRangeTree(
    std::span<const SlopedRay> rays, std::int32_t first_z, std::int32_t last_z, SweepCounts& counts)
    : x_points_(points_of(rays, x_point))
    , y_points_(points_of(rays, y_point))
    , x_(x_points_, first_z, last_z)
    , y_(y_points_, first_z, last_z)
    , counts_(counts)
    , is_added_(rays.size())
    , entries_(bytes_of_entries(rays.size()) + alignof(std::max_align_t)) {
    counts_.pairs += pairs_of(rays.size());
    for (std::size_t size = std::size_t{1} << leaf_bits;; size *= 2) {
        std::vector<Node>& level = levels_.emplace_back();
        const std::size_t count = (rays.size() + size - 1) / size;
        level.reserve(count);
        for (std::size_t i = 0; i < count; ++i)
            level.push_back(
                {static_cast<std::uint32_t>(i * size),
                 static_cast<std::uint32_t>(std::min((i + 1) * size, rays.size()) - 1),
                 RaysByY(ByY{this}, &entries_)});
        if (count <= 1)
            break;
    }
}

bool KineticRangeTree::pass_crossing(std::int32_t z) {
    const CrossingZ limit = {z, 1};
    std::optional<Crossing> in_x = x_.next();
    std::optional<Crossing> in_y = y_.next();
    if (in_x && limit < in_x->z)
        in_x.reset();
    if (in_y && limit < in_y->z)
        in_y.reset();
    if (!in_x && !in_y)
        return false;
    if (in_x && !(in_y && in_y->z < in_x->z))
        pass_in_x(*in_x);
    else
        pass_in_y(*in_y);
    return true;
}

/// Each takes the other's place, and so moves to the nodes over that.
void KineticRangeTree::pass_in_x(const Crossing& crossing) {
    const std::uint32_t left_place = x_.place(crossing.left);
    const std::uint32_t right_place = x_.place(crossing.right);
    const auto move = [&](std::uint32_t ray, Node& from, Node& to) {
        if (is_added_[ray] == 0)
            return;
        to.by_y.insert(from.by_y.extract(ray));
        counts_.moves += 2;
    };
    for (std::size_t level = 1; level < levels_.size(); ++level) {
        Node& left = levels_[level][node_number(level, left_place)];
        Node& right = levels_[level][node_number(level, right_place)];
        if (&left == &right)
            break;
        move(crossing.left, left, right);
        move(crossing.right, right, left);
    }
    x_.pass();
    ++counts_.x_swaps;
}

/// Nodes that have both are those that are over both places.
void KineticRangeTree::pass_in_y(const Crossing& crossing) {
    const std::uint32_t left_place = x_.place(crossing.left);
    const std::uint32_t right_place = x_.place(crossing.right);
    std::size_t first = levels_.size();
    if (is_added_[crossing.left] != 0 && is_added_[crossing.right] != 0)
        while (first > 1
               && node_number(first - 1, left_place) == node_number(first - 1, right_place))
            --first;
    // The places are what the search trees are ordered by: they must not change while both stand in
    // one.
    taken_out_.clear();
    for (std::size_t level = first; level < levels_.size(); ++level)
        taken_out_.push_back(
            levels_[level][node_number(level, left_place)].by_y.extract(crossing.left));
    y_.pass();
    for (std::size_t level = first; level < levels_.size(); ++level)
        levels_[level][node_number(level, left_place)].by_y.insert(
            std::move(taken_out_[level - first]));
    counts_.moves += 2 * taken_out_.size();
    ++counts_.y_swaps;
}

void KineticRangeTree::add(std::span<const std::uint32_t> rays) {
    // In the order of y, so that each goes to the end of what has been added with it.
    by_y_.assign(rays.begin(), rays.end());
    std::sort(by_y_.begin(), by_y_.end(), [&](std::uint32_t a, std::uint32_t b) {
        return y_.place(a) < y_.place(b);
    });
    counts_.comparisons += comparisons_of_sort(rays.size());
    for (const std::uint32_t ray : by_y_) {
        is_added_[ray] = 1;
        for_each_above(x_.place(ray), [&](Node& node) { node.by_y.insert(node.by_y.end(), ray); });
    }
    counts_.moves += rays.size() * (levels_.size() - 1);
}

void KineticRangeTree::remove(std::uint32_t ray) {
    const std::uint32_t place = x_.place(ray);
    if (is_added_[ray] != 0) {
        for_each_above(place, [&](Node& node) { node.by_y.erase(node.by_y.find(ray)); });
        counts_.moves += levels_.size() - 1;
        is_added_[ray] = 0;
    }
    x_.remove(ray);
    y_.remove(ray);
    find_ends(place);
}

/// Of the nodes over a place that has become empty.
void KineticRangeTree::find_ends(std::uint32_t place) {
    Node& leaf = levels_[0][node_number(0, place)];
    const auto is_empty = [&](std::uint32_t at) { return x_.at(at) == KineticOrder::none; };
    while (leaf.first < leaf.last && is_empty(leaf.first))
        ++leaf.first;
    while (leaf.first < leaf.last && is_empty(leaf.last))
        --leaf.last;
    if (is_empty(leaf.first))
        leaf.first = leaf.last = KineticOrder::none;
    for (std::size_t level = 1; level < levels_.size(); ++level) {
        const std::size_t number = node_number(level, place);
        const std::vector<Node>& below = levels_[level - 1];
        const Node& left = below[2 * number];
        const Node& right = below[std::min(2 * number + 1, below.size() - 1)];
        Node& node = levels_[level][number];
        node.first = left.first != KineticOrder::none ? left.first : right.first;
        node.last = right.last != KineticOrder::none ? right.last : left.last;
    }
}

void KineticRangeTree::append_met(const IsoRectangle& rectangle, std::vector<std::uint32_t>& met) {
    rectangle_ = rectangle;
    met_ = &met;
    const std::size_t before = met.size();
    ++counts_.rectangles;
    if (x_.size() > 0)
        search(levels_.size() - 1, 0);
    counts_.reports += met.size() - before;
}

void KineticRangeTree::search(std::size_t level, std::uint32_t number) {
    const Node& node = levels_[level][number];
    ++counts_.nodes;
    if (node.first == KineticOrder::none)
        return;
    const std::int64_t lowest = x_at(x_.at(node.first), rectangle_.z);
    const std::int64_t highest = x_at(x_.at(node.last), rectangle_.z);
    if (highest < rectangle_.lower_x || rectangle_.upper_x < lowest)
        return;
    if (level == 0)
        return look_at_leaf(node);
    if (rectangle_.lower_x <= lowest && highest <= rectangle_.upper_x)
        return append_in_y(node);
    search(level - 1, 2 * number);
    if (2 * number + 1 < levels_[level - 1].size())
        search(level - 1, 2 * number + 1);
}

void KineticRangeTree::look_at_leaf(const Node& leaf) {
    for (std::uint32_t place = leaf.first; place <= leaf.last; ++place) {
        const std::uint32_t ray = x_.at(place);
        if (ray == KineticOrder::none || is_added_[ray] == 0)
            continue;
        ++counts_.comparisons;
        const std::int64_t x = x_at(ray, rectangle_.z);
        const std::int64_t y = y_at(ray, rectangle_.z);
        if (rectangle_.lower_x <= x && x <= rectangle_.upper_x && rectangle_.lower_y <= y
            && y <= rectangle_.upper_y)
            met_->push_back(ray);
    }
}

void KineticRangeTree::append_in_y(const Node& node) {
    auto ray = node.by_y.lower_bound(LowerBound{rectangle_.lower_y, rectangle_.z});
    for (; ray != node.by_y.end() && y_at(*ray, rectangle_.z) <= rectangle_.upper_y; ++ray)
        met_->push_back(*ray);
}

double KineticRangeTree::bytes_forecast(std::size_t rays) {
    std::size_t nodes = 1;
    for (std::size_t size = std::size_t{1} << leaf_bits; size < rays; size *= 2)
        nodes += (rays + size - 1) / size;
    constexpr std::size_t each =
        2 * sizeof(PlanePoint) + sizeof(std::uint8_t) + sizeof(std::uint32_t);
    return 2 * KineticOrder::bytes_forecast(rays)
        + static_cast<double>(rays * each + bytes_of_entries(rays) + nodes * sizeof(Node));
}

} // namespace vera
