// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/box_tree_nodes.h"
#include "vera/base/parallel.h"

namespace vera::detail {

/// Takes nodes below the root out of the tree, one after the other and the largest part of all
/// first, and puts each where it makes the sum of the surfaces of the nodes' boxes the least
/// (Bittner, Hapala and Havran 2013). What follows from children is then right up to the root, but
/// for the costs. Throws Cancelled.
void reinsert_nodes(BinaryNode& root, double part, const CancelFlag* cancel);

} // namespace vera::detail
