// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/element_records.h"
#include "vera/accel/local_geometry.h"
#include "vera/math/box3.h"
#include "vera/math/vec3.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera::detail {

/// What a cell holds: nothing, a list of elements, or a grid of its own.
struct Cell {
    static constexpr std::uint32_t grid_bit = 0x80000000U;
    static constexpr std::uint32_t most = grid_bit - 1;

    std::uint32_t value = 0;

    bool empty() const { return value == 0; }

    bool is_grid() const { return (value & grid_bit) != 0; }

    /// Number of the grid in GeometryGrids::grids.
    std::uint32_t grid() const { return value & ~grid_bit; }

    /// Place in GeometryGrids::lists: there stands how many elements follow.
    std::uint32_t list() const { return value; }
};

/// A regular grid. Cell (x, y, z) is number first_cell + x + counts[0] * (y + counts[1] * z).
struct Grid {
    Box3 box; ///< in the geometry's local coordinates, as all that follows
    Vec3 cell_size;
    Vec3 cells_per_unit; ///< 1 / cell_size
    std::array<std::int32_t, 3> counts = {1, 1, 1};
    std::size_t first_cell = 0;
};

/// The grids of the main scene or of a subscene.
struct GeometryGrids : LocalGeometry {
    std::vector<Grid> grids; ///< the first is that of the whole geometry; none where it is empty
    std::vector<Cell> cells;
    std::vector<std::uint32_t> lists;
    std::vector<ElementRecord> records; ///< of every element
    std::size_t levels = 0;
};

} // namespace vera::detail
