// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/grid_tree.h"
#include "vera/base/parallel.h"
#include "vera/math/box3.h"
#include "vera/math/transform.h"
#include "vera/scene/scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// A cell of the tree of grids that holds something, where it stands in the scene.
struct FullCell {
    Affine3 to_scene; ///< carries the unit cube, from 0 to 1 on each axis, to the cell
    std::uint32_t level = 1;
    std::uint32_t objects = 0; ///< in its list; 0 for a grid that is not looked into
};

/// What the grids of one level hold together, each as often as it is called. A subscene's grid
/// stands one level below the one that its call is in.
struct GridLevel {
    std::size_t grids = 0;
    std::size_t cells = 0;
    std::size_t full_cells = 0; ///< with a list, or with a grid of their own
    std::size_t references = 0; ///< in the lists
    std::size_t longest_list = 0;
};

/// The tree of grids from the top down, as far as it was looked into.
struct GridCells {
    Box3 box; ///< of the scene's grid
    std::array<std::int32_t, 3> counts = {0, 0, 0};
    std::vector<GridLevel> levels;
    std::vector<FullCell> cells;
    bool whole = true; ///< whether no grid is below those
};

/// The grids of at most `levels` levels, and of as few as leaves at most `most_cells` full cells;
/// of the first level in any case. A cell with nothing but calls of subscenes that are looked into
/// is left out. Throws as make_grid_tree does.
GridCells grid_cells(
    const Scene& scene,
    const GridSettings& settings,
    std::size_t levels,
    std::size_t most_cells,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
