// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/tree_kind.h"

#include "vera/theory/conjugation_tree.h"
#include "vera/theory/optimal_partition_tree.h"

#include <utility>

namespace vera {

PartitionTree partition_tree(
    TreeKind kind,
    std::span<const PlanePoint> points,
    std::vector<std::uint32_t> numbers,
    std::size_t leaf_size,
    const Progress& progress,
    const CancelFlag* cancel,
    EqualPoints equal) {
    if (kind == TreeKind::optimal)
        return OptimalPartitionTree(points, std::move(numbers), leaf_size, progress, cancel, equal);
    return ConjugationTree(points, std::move(numbers), leaf_size, progress, cancel, equal);
}

double depth_factor(TreeKind kind) {
    return kind == TreeKind::optimal ? OptimalPartitionTree::depth_factor : 1;
}

} // namespace vera
