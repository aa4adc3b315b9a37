// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/box_tree.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace vera::detail {

/// A node of a tree in which each has two children or, as a leaf, none.
struct BinaryNode {
    FloatBox box;
    float content = 0;                    ///< the surfaces of the references' boxes
    const BinaryNode* children = nullptr; ///< two, side by side
    std::uint32_t first = 0;              ///< reference
    std::uint32_t size = 0;               ///< in references
    /// The least sum of the surfaces of the nodes and leaves that the node is
    /// made into, where it is made into at most 1, 2, ... 7 children of a
    /// WideNode.
    std::array<float, tree_width - 1> costs = {};
};

/// Fills in content and costs from those of the children.
void fill_costs(BinaryNode& node);

/// The same of a leaf, with the surfaces of its references' boxes.
void fill_costs_of_leaf(BinaryNode& node, float content);

/// Makes the nodes of the tree of those of a tree of two children each, such
/// that the sum of the surfaces of nodes and leaves is the least (Ylitie,
/// Karras and Laine 2017).
void make_wide_nodes(const BinaryNode& root, BoxTree& tree);

/// Notes in which order rays come to the node's children, of which there are
/// count. Those of an octant come to them by where the middles of the boxes lie
/// along the octant's diagonal; those that ask for anything come first to the
/// ones that are the fullest.
void set_orders(WideNode& node, std::size_t count, const std::array<float, tree_width>& fullness);

} // namespace vera::detail
