// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/box_tree.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace vera::detail {

/// A node of a tree in which each has two children or, as a leaf, none.
struct BinaryNode {
    FloatBox box;
    float content = 0;                        ///< the sum of the references': see build_box_tree()
    std::array<BinaryNode*, 2> children = {}; ///< null in a leaf
    BinaryNode* parent = nullptr;
    std::uint32_t first = 0;  ///< reference of a leaf
    std::uint32_t size = 0;   ///< in references
    std::uint32_t height = 0; ///< of levels below
    /// The least sum of the surfaces of the nodes and leaves that the node is made into, where it
    /// is made into at most 1, 2, ... 7 children of a WideNode.
    std::array<float, tree_width - 1> costs = {};

    bool is_leaf() const { return children[0] == nullptr; }
};

/// Of visiting what is in the box: its surface, and infinite where that is no number.
inline float cost_of_visit(const FloatBox& box) {
    const float cost = surface(box);
    return std::isnan(cost) ? HUGE_VALF : cost;
}

/// Fills in what follows from the children, without the costs.
void join_children(BinaryNode& node);

/// Fills in the costs.
void fill_costs(BinaryNode& node);

/// Makes the nodes of the tree of those of a tree of two children each, such that the sum of the
/// surfaces of nodes and leaves is the least (Ylitie, Karras and Laine 2017). The children of a
/// node come by how much of a hit rays may expect there for a visit of a node or leaf, the most
/// first: that is the order for rays that ask for anything (in the spirit of Ize and Hansen 2011,
/// RTSAH).
void make_wide_nodes(const BinaryNode& root, BoxTree& tree);

/// Notes in which order rays come to the node's children, of which there are count. Those of an
/// octant come to them by where the middles of the boxes lie along the octant's diagonal.
void set_orders(WideNode& node, std::size_t count);

} // namespace vera::detail
