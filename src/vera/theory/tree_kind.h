// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/theory/partition_tree.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// Of which partition trees structures are made that ask them in the same way: that of the paper,
/// or what became of it.
enum class TreeKind { conjugation, optimal };

/// A tree of that kind, as its constructor makes it.
PartitionTree partition_tree(
    TreeKind kind,
    std::span<const PlanePoint> points,
    std::vector<std::uint32_t> numbers,
    std::size_t leaf_size,
    const Progress& progress,
    const CancelFlag* cancel,
    EqualPoints equal);

/// In how many nodes of one tree a point is, at most or about, of that kind by those of halves.
double depth_factor(TreeKind kind);

} // namespace vera
