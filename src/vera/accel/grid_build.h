// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/grid_structures.h"
#include "vera/accel/grid_tree.h"
#include "vera/scene/scene.h"

#include <functional>
#include <vector>

namespace vera::detail {

/// Counts of cells along the axes, about `cells` together, so that they are about cubes; one along
/// an axis on which the box is flat.
std::array<std::int32_t, 3> cell_counts(Vec3 extent, double cells);

/// The grids of a geometry of the scene, given the bounds of the subscenes that it calls.
GeometryGrids build_geometry_grids(
    const Geometry& geometry,
    const std::vector<Box3>& subscene_bounds,
    const GridSettings& settings,
    const CancelFlag* cancel);

/// The bytes that building these grids takes at its peak, from a sample of the elements.
std::size_t forecast_bytes(
    const Geometry& geometry,
    const std::vector<Box3>& subscene_bounds,
    const GridSettings& settings);

} // namespace vera::detail
