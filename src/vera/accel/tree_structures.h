// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/element_records.h"
#include "vera/accel/local_geometry.h"
#include "vera/accel/tree_child.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera::detail {

/// A node: the boxes of its children in local coordinates, and what these are. Planes 0 to 2 bound
/// the boxes from below along each axis, planes 3 to 5 from above. The boxes of absent children,
/// which stand behind the others, are empty.
struct alignas(64) WideNode {
    std::array<std::array<float, tree_width>, 6> planes;
    std::array<TreeChild, tree_width> children;
};

/// The number of the child that waits at this place in this order, the longest at place 0.
inline std::size_t waiting_at(const WideNode& node, std::size_t place, std::size_t order) {
    return order == any_order ? tree_width - 1 - place : node.children[place].in_order(order);
}

/// Values of the elements of a block: row 0 holds their numbers, row 1 + i value i of their
/// records. What stands behind the last element is a copy of it.
using BlockRow = std::array<float, block_width>;

/// How many values a record of the kind has.
constexpr std::size_t value_count(ElementRecord::Kind kind) {
    switch (kind) {
    case ElementRecord::Kind::sphere:
        return 4;
    case ElementRecord::Kind::triangle:
        return 9;
    case ElementRecord::Kind::quadrangle:
        return 11;
    case ElementRecord::Kind::mantle:
        return 9;
    case ElementRecord::Kind::cylinder:
        return 8;
    case ElementRecord::Kind::box:
    case ElementRecord::Kind::call:
        return 6;
    }
    return 0;
}

/// No path from the root is longer: see where the builder cuts in halves.
constexpr std::size_t most_tree_levels = 80;

/// The tree of boxes of the main scene or of a subscene.
struct GeometryTree : LocalGeometry {
    std::vector<WideNode> nodes; ///< the first is the root; none where the geometry is empty
    std::vector<BlockRow> rows;
    std::size_t blocks = 0;
    std::size_t elements = 0;
    std::size_t levels = 0;
};

} // namespace vera::detail
