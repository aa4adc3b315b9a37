// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/box_tree_nodes.h"

#include "vera/base/check.h"
#include "vera/base/parallel.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace vera::detail {

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

/// How many children of a WideNode the left one of a binary node is made into, where both are made
/// into so many, and what that costs.
struct Share {
    std::size_t left = 1;
    float cost = infinite;
};

Share best_share(const BinaryNode& node, std::size_t children) {
    const auto& [left, right] = node.children;
    Share best;
    for (std::size_t i = 1; i < children; ++i) {
        const float cost = left->costs[i - 1] + right->costs[children - i - 1];
        if (cost < best.cost)
            best = {i, cost};
    }
    return best;
}

WideNode empty_node() {
    WideNode node = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        node.planes[axis].fill(infinite);
        node.planes[3 + axis].fill(-infinite);
    }
    return node;
}

void set_box(WideNode& node, std::size_t child, const FloatBox& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        node.planes[axis][child] = box.lower[axis];
        node.planes[3 + axis][child] = box.upper[axis];
    }
}

/// Binary nodes that are the children of a wide one.
struct Children {
    std::array<const BinaryNode*, tree_width> nodes = {};
    std::size_t count = 0;
};

/// Adds what the node is made into, as at most so many children.
void share_out(const BinaryNode& node, std::size_t count, Children& children) {
    if (!node.is_leaf() && count > 1) {
        const Share share = best_share(node, count);
        // The root is never its own child.
        if (count == tree_width || share.cost <= node.costs[0]) {
            share_out(*node.children[0], share.left, children);
            share_out(*node.children[1], count - share.left, children);
            return;
        }
    }
    children.nodes[children.count++] = &node;
}

/// How much of a hit a ray that meets the node's box may expect for each visit of what is below.
float yield(const BinaryNode& node) {
    const float hits = node.content / node.costs[0];
    return hits > 0 ? hits : 0; // where surfaces are 0, or infinite, it may be no number
}

/// Puts them in the order for rays that ask for anything. They are few: std::stable_sort would ask
/// for memory.
void put_in_order(Children& children) {
    const auto first = children.nodes.begin();
    const auto last = first + static_cast<std::ptrdiff_t>(children.count);
    for (auto next = first; next != last; ++next) {
        const auto place =
            std::upper_bound(first, next, *next, [](const BinaryNode* a, const BinaryNode* b) {
                return yield(*a) > yield(*b);
            });
        std::rotate(place, next, next + 1);
    }
}

/// A child that is made later, on any thread.
struct Deferred {
    std::size_t node = 0;
    std::size_t child = 0;
    std::size_t level = 0; ///< of the node
    const BinaryNode* root = nullptr;
};

/// What a part of the tree is made into.
class WideNodes {
public:
    /// Makes the node and what is below it; what has at most deferred_size references is deferred.
    std::size_t make(const BinaryNode& root, std::size_t level, std::size_t deferred_size) {
        levels = std::max(levels, level);
        const std::size_t number = nodes.size();
        nodes.emplace_back();
        Children children;
        share_out(root, tree_width, children);
        put_in_order(children);
        WideNode node = empty_node();
        for (std::size_t i = 0; i < children.count; ++i) {
            const BinaryNode& child = *children.nodes[i];
            set_box(node, i, child.box);
            if (child.is_leaf()) {
                node.children[i] = TreeChild::block(child.first, child.size - 1, 1);
                ++leaves;
            } else if (child.size <= deferred_size) {
                deferred.push_back({number, i, level, &child});
            } else {
                node.children[i] = TreeChild::node(make(child, level + 1, deferred_size));
            }
        }
        set_orders(node, children.count);
        nodes[number] = node;
        return number;
    }

    std::vector<WideNode> nodes;
    std::vector<Deferred> deferred;
    std::size_t leaves = 0;
    std::size_t levels = 0;
};

} // namespace

void join_children(BinaryNode& node) {
    const BinaryNode& left = *node.children[0];
    const BinaryNode& right = *node.children[1];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        node.box.lower[axis] = std::min(left.box.lower[axis], right.box.lower[axis]);
        node.box.upper[axis] = std::max(left.box.upper[axis], right.box.upper[axis]);
    }
    node.content = left.content + right.content;
    node.size = left.size + right.size;
    node.height = 1 + std::max(left.height, right.height);
}

void fill_costs(BinaryNode& node) {
    const float visit = cost_of_visit(node.box);
    if (node.is_leaf()) {
        node.costs.fill(visit);
        return;
    }
    const float alone = visit + best_share(node, tree_width).cost;
    node.costs[0] = alone;
    for (std::size_t i = 2; i < tree_width; ++i)
        node.costs[i - 1] = std::min(alone, best_share(node, i).cost);
}

void make_wide_nodes(const BinaryNode& root, BoxTree& tree) {
    WideNodes top;
    constexpr std::size_t parts = 64;
    top.make(root, 1, root.size / parts);
    std::vector<WideNodes> below(top.deferred.size());
    parallel_ranges(below.size(), 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            below[i].make(*top.deferred[i].root, top.deferred[i].level + 1, 0);
    });
    std::vector<std::size_t> first_nodes;
    std::size_t count = top.nodes.size();
    for (std::size_t i = 0; i < below.size(); ++i) {
        const Deferred& place = top.deferred[i];
        top.nodes[place.node].children[place.child].bits += count;
        first_nodes.push_back(count);
        count += below[i].nodes.size();
        top.leaves += below[i].leaves;
        top.levels = std::max(top.levels, below[i].levels);
    }
    VERA_CHECK(top.levels <= most_tree_levels);
    tree.nodes = std::move(top.nodes);
    tree.nodes.resize(count);
    tree.leaves = top.leaves;
    tree.levels = top.levels;
    parallel_ranges(below.size(), 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            WideNode* to = tree.nodes.data() + first_nodes[i];
            for (const WideNode& node : below[i].nodes) {
                *to = node;
                for (TreeChild& child : to->children)
                    if (child.is_block() == 0)
                        child.bits += first_nodes[i];
                ++to;
            }
        }
    });
}

} // namespace vera::detail
