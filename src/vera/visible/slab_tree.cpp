// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/slab_tree.h"

#include "vera/base/long_loop.h"
#include "vera/base/random.h"

#include <algorithm>
#include <numeric>
#include <span>

namespace vera {

/// Sweeps over the slabs from the left.
class SlabTreeBuilder {
public:
    explicit SlabTreeBuilder(SlabTree& tree)
        : tree_(tree)
        , segments_(tree.segments_) {}

    void build(const CancelFlag* cancel);

private:
    using Side = SlabTree::Side;
    using Node = SlabTree::Node;
    static constexpr std::uint32_t no_node = SlabTree::no_node;

    // Each returns the root of what becomes of the tree under the node.
    std::uint32_t inserted(std::uint32_t node, std::uint32_t segment);
    std::uint32_t erased(std::uint32_t node, std::uint32_t segment);
    std::pair<std::uint32_t, std::uint32_t> split(std::uint32_t node, std::uint32_t segment);
    std::uint32_t merged(std::uint32_t lower, std::uint32_t upper);
    std::uint32_t with_child(std::uint32_t node, Side side, std::uint32_t child);
    std::uint32_t new_node(std::uint32_t segment, std::uint32_t lower, std::uint32_t upper);

    bool is_above(std::uint32_t segment, std::uint32_t node) {
        ++tree_.build_steps_;
        return segments_.is_above(segment, tree_.nodes_[node].segment);
    }

    std::uint32_t child(std::uint32_t node, Side side) const {
        return SlabTree::child(tree_.nodes_[node], side, version_);
    }

    /// Which of two nodes lies nearer to the root.
    std::uint64_t priority(std::uint32_t node) const {
        return scrambled_bits(tree_.nodes_[node].segment);
    }

    SlabTree& tree_;
    const MapSegments& segments_;
    std::uint32_t version_ = 0;
};

std::uint32_t
SlabTreeBuilder::new_node(std::uint32_t segment, std::uint32_t lower, std::uint32_t upper) {
    ++tree_.build_steps_;
    Node& node = tree_.nodes_.emplace_back();
    node.segment = segment;
    node.children = {lower, upper};
    node.version = version_;
    return static_cast<std::uint32_t>(tree_.nodes_.size() - 1);
}

std::uint32_t
SlabTreeBuilder::with_child(std::uint32_t number, Side side, std::uint32_t new_child) {
    if (child(number, side) == new_child)
        return number;
    Node& node = tree_.nodes_[number];
    const bool has_changed = node.changed_version <= version_;
    if (node.version == version_) {
        // No other version has it yet.
        node.children[side] = new_child;
        return number;
    }
    if (!has_changed || (node.changed_version == version_ && node.changed_side == side)) {
        node.changed_version = version_;
        node.changed_side = side;
        node.changed_child = new_child;
        return number;
    }
    std::array<std::uint32_t, 2> children = {
        child(number, Side::below), child(number, Side::above)};
    children[side] = new_child;
    return new_node(node.segment, children[Side::below], children[Side::above]);
}

/// What lies below the segment, and what lies above it.
std::pair<std::uint32_t, std::uint32_t>
SlabTreeBuilder::split(std::uint32_t node, std::uint32_t segment) {
    if (node == no_node)
        return {no_node, no_node};
    if (is_above(segment, node)) {
        const auto [lower, upper] = split(child(node, Side::above), segment);
        return {with_child(node, Side::above, lower), upper};
    }
    const auto [lower, upper] = split(child(node, Side::below), segment);
    return {lower, with_child(node, Side::below, upper)};
}

std::uint32_t SlabTreeBuilder::inserted(std::uint32_t node, std::uint32_t segment) {
    if (node == no_node)
        return new_node(segment, no_node, no_node);
    if (scrambled_bits(segment) > priority(node)) {
        const auto [lower, upper] = split(node, segment);
        return new_node(segment, lower, upper);
    }
    const Side side = is_above(segment, node) ? Side::above : Side::below;
    return with_child(node, side, inserted(child(node, side), segment));
}

std::uint32_t SlabTreeBuilder::merged(std::uint32_t lower, std::uint32_t upper) {
    if (lower == no_node || upper == no_node)
        return lower == no_node ? upper : lower;
    if (priority(lower) > priority(upper))
        return with_child(lower, Side::above, merged(child(lower, Side::above), upper));
    return with_child(upper, Side::below, merged(lower, child(upper, Side::below)));
}

std::uint32_t SlabTreeBuilder::erased(std::uint32_t node, std::uint32_t segment) {
    if (node == no_node)
        throw CrossingBorders();
    if (tree_.nodes_[node].segment == segment)
        return merged(child(node, Side::below), child(node, Side::above));
    const Side side = is_above(segment, node) ? Side::above : Side::below;
    return with_child(node, side, erased(child(node, side), segment));
}

void SlabTreeBuilder::build(const CancelFlag* cancel) {
    // Vertical borders lie between slabs.
    std::vector<std::uint32_t> beginning;
    for (std::uint32_t i = 0; i < segments_.segments.size(); ++i)
        if (!segments_.is_vertical(i))
            beginning.push_back(i);
    std::vector<std::uint32_t> ending = beginning;
    std::sort(beginning.begin(), beginning.end(), [&](std::uint32_t a, std::uint32_t b) {
        const std::uint32_t at_a = segments_.segments[a].begin;
        const std::uint32_t at_b = segments_.segments[b].begin;
        return at_a != at_b ? at_a < at_b : a < b;
    });
    std::sort(ending.begin(), ending.end(), [&](std::uint32_t a, std::uint32_t b) {
        const std::uint32_t at_a = segments_.segments[a].end;
        const std::uint32_t at_b = segments_.segments[b].end;
        return at_a != at_b ? at_a < at_b : a < b;
    });
    std::size_t begun = 0;
    std::size_t ended = 0;
    std::uint32_t root = no_node;
    const auto count = static_cast<std::uint32_t>(segments_.points.size());
    const LongLoop loop(count, {}, cancel);
    for (std::uint32_t first = 0, last = 0; first < count; first = last) {
        while (last < count && order_by_x(segments_.points[first], segments_.points[last]) == 0) {
            loop.turn(last);
            ++last;
        }
        version_ = static_cast<std::uint32_t>(tree_.roots_.size());
        for (; ended < ending.size() && segments_.segments[ending[ended]].end < last; ++ended)
            root = erased(root, ending[ended]);
        for (; begun < beginning.size() && segments_.segments[beginning[begun]].begin < last;
             ++begun)
            root = inserted(root, beginning[begun]);
        tree_.slabs_.push_back(first);
        tree_.roots_.push_back(root);
    }
}

SlabTree::SlabTree(MapSegments segments, const CancelFlag* cancel)
    : segments_(std::move(segments)) {
    SlabTreeBuilder(*this).build(cancel);
}

std::uint32_t SlabTree::region_at(const MapPoint& point, LocatorSteps& steps) const {
    ++steps.queries;
    const auto behind =
        std::partition_point(slabs_.begin(), slabs_.end(), [&](std::uint32_t begin) {
            ++steps.comparisons;
            return order_by_x(segments_.points[begin], point) <= 0;
        });
    if (behind == slabs_.begin())
        return no_region;
    const auto version = static_cast<std::uint32_t>(behind - slabs_.begin() - 1);
    std::uint32_t region = no_region;
    for (std::uint32_t node = roots_[version]; node != no_node;) {
        ++steps.comparisons;
        const std::uint32_t segment = nodes_[node].segment;
        const Side side = segments_.side(segment, point) >= 0 ? above : below;
        if (side == above)
            region = segments_.segments[segment].above;
        node = child(nodes_[node], side, version);
    }
    return region;
}

std::size_t SlabTree::memory() const {
    return segments_.bytes() + nodes_.capacity() * sizeof(Node)
        + (slabs_.capacity() + roots_.capacity()) * sizeof(std::uint32_t);
}

} // namespace vera
