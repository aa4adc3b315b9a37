// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/tree_structures.h"
#include "vera/base/parallel.h"

#include <vector>

namespace vera::detail {

/// The tree of a geometry of the scene, given the bounds of the subscenes that it calls: the same
/// whatever the number of threads. Throws Cancelled.
GeometryTree build_geometry_tree(
    const Geometry& geometry, const std::vector<Box3>& subscene_bounds, const CancelFlag* cancel);

/// The bytes that building this tree takes at its peak, about.
std::size_t forecast_tree_bytes(const Geometry& geometry);

} // namespace vera::detail
