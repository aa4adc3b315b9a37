// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/box3.h"
#include "vera/math/vec3.h"
#include "vera/scene/geometry.h"

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

/// How an element is met by a cheap test in single precision that never misses a ray which meets
/// the element, in local coordinates.
struct ElementRecord {
    enum class Kind : std::uint32_t {
        sphere,     ///< center, radius
        triangle,   ///< corner, edge e to the second corner, edge f to the third
        quadrangle, ///< corner, edges e and f to its neighbours, x and y: corner + x e + y f is the
                    ///< opposite corner
        box,        ///< lower corner, upper corner
        cylinder,   ///< center, axis (unit), radius, half its length
        call        ///< of a subscene: as box
    };

    std::array<float, 11> values = {};
    Kind kind = Kind::box;
};

/// The grids of the main scene or of a subscene.
///
/// Local coordinates: `center` moved to 0 and all multiplied by `scale`, a power of two that makes
/// the bounds fit into [-1, 1]. So single precision is good for what only prunes, and a scene and
/// its copy in another unit of length behave alike.
struct GeometryGrids {
    const Geometry* geometry = nullptr;
    Box3 bounds; ///< of what rays can meet, in the geometry's own coordinates; empty where nothing
    Vec3 center;
    double scale = 1;
    Box3 local_bounds;
    double coordinate_size = 0; ///< the largest that says where anything lies, in scene units
    std::vector<Grid> grids;    ///< the first is that of the whole geometry; none where it is empty
    std::vector<Cell> cells;
    std::vector<std::uint32_t> lists;
    std::vector<ElementRecord> records; ///< of every element
    std::size_t levels = 0;
};

inline Vec3 local_point(const GeometryGrids& grids, Vec3 point) {
    return grids.scale * (point - grids.center);
}

} // namespace vera::detail
