// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/box_tree_reinsertion.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vera::detail {

namespace {

/// Half the surface of a box that holds both.
float surface_together(const FloatBox& a, const FloatBox& b) {
    FloatBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lower[axis] = std::min(a.lower[axis], b.lower[axis]);
        box.upper[axis] = std::max(a.upper[axis], b.upper[axis]);
    }
    return surface(box);
}

/// Puts one node into another's place below its parent.
void put(BinaryNode& node, const BinaryNode& other) {
    BinaryNode& parent = *other.parent;
    parent.children[parent.children[0] == &other ? 0 : 1] = &node;
    node.parent = &parent;
}

class Reinsertion {
public:
    explicit Reinsertion(BinaryNode& root)
        : root_(root)
        , most_depth_(most_tree_levels - 1 - depth_of(root, nullptr)) {}

    void reinsert(BinaryNode& node) {
        // The parent is taken out with the node, and moves with it.
        BinaryNode& parent = *node.parent;
        if (&parent == &root_)
            return;
        BinaryNode& other = *parent.children[parent.children[0] == &node ? 1 : 0];
        const float before = surface(parent.box) + surfaces_above(parent);
        put(other, parent);
        refit_above(other);
        const float gain = before - surfaces_above(other);

        BinaryNode& place = best_place(node, other, gain);
        put(parent, place);
        parent.children = {&place, &node};
        place.parent = node.parent = &parent;
        join_children(parent);
        refit_above(parent);
    }

private:
    /// How deep the node is below another, or below none.
    static std::size_t depth_of(const BinaryNode& node, const BinaryNode* root) {
        std::size_t depth = 0;
        for (const BinaryNode* above = &node; above != root && above->parent != nullptr;
             above = above->parent)
            ++depth;
        return depth;
    }

    float surfaces_above(const BinaryNode& node) const {
        float sum = 0;
        for (const BinaryNode* above = &node; above != &root_;) {
            above = above->parent;
            sum += surface(above->box);
        }
        return sum;
    }

    void refit_above(BinaryNode& node) {
        for (BinaryNode* above = &node; above != &root_;) {
            above = above->parent;
            join_children(*above);
        }
    }

    /// Whether the node can stand beside another without the tree becoming too deep.
    bool fits(const BinaryNode& moved, const BinaryNode& place) const {
        return depth_of(place, &root_) + 1 + std::max(moved.height, place.height) <= most_depth_;
    }

    /// Beside which node a node that was taken out adds the least to the sum of surfaces; the one
    /// where it was, where none adds less than the gain.
    BinaryNode& best_place(const BinaryNode& moved, BinaryNode& was, float gain) {
        BinaryNode* best = &was;
        float least = gain;
        const float own = surface(moved.box);
        // What is added above a node, and on the way to its children, bounds from below what is
        // added anywhere below.
        waiting_.assign(1, {0, &root_});
        while (!waiting_.empty() && waiting_.front().added + own < least) {
            std::pop_heap(waiting_.begin(), waiting_.end(), comes_later);
            const auto [added_above, node] = waiting_.back();
            waiting_.pop_back();
            const float added = added_above + surface_together(node->box, moved.box);
            if (added < least && node != &root_ && fits(moved, *node)) {
                best = node;
                least = added;
            }
            const float added_below = added - surface(node->box);
            if (node->is_leaf() || !(added_below + own < least))
                continue;
            for (BinaryNode* child : node->children) {
                waiting_.push_back({added_below, child});
                std::push_heap(waiting_.begin(), waiting_.end(), comes_later);
            }
        }
        return *best;
    }

    struct Waiting {
        float added = 0;
        BinaryNode* node = nullptr;
    };

    static bool comes_later(const Waiting& a, const Waiting& b) { return a.added > b.added; }

    BinaryNode& root_;
    std::size_t most_depth_;       ///< of leaves below the root
    std::vector<Waiting> waiting_; ///< a heap
};

struct Sized {
    float surface = 0;
    BinaryNode* node = nullptr;
};

void add_below(BinaryNode& node, std::vector<Sized>& all) {
    if (node.is_leaf())
        return;
    for (BinaryNode* child : node.children) {
        all.push_back({cost_of_visit(child->box), child});
        add_below(*child, all);
    }
}

} // namespace

void reinsert_nodes(BinaryNode& root, double part, const CancelFlag* cancel) {
    std::vector<Sized> nodes;
    add_below(root, nodes);
    std::stable_sort(nodes.begin(), nodes.end(), [](const Sized& a, const Sized& b) {
        return a.surface > b.surface;
    });
    nodes.resize(static_cast<std::size_t>(part * static_cast<double>(nodes.size())));
    Reinsertion reinsertion(root);
    for (const Sized& sized : nodes) {
        if (cancel != nullptr)
            cancel->throw_if_raised();
        reinsertion.reinsert(*sized.node);
    }
}

} // namespace vera::detail
