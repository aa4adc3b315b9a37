// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/box3.h"
#include "vera/math/vec3.h"
#include "vera/scene/geometry.h"
#include "vera/scene/outline_table.h"

#include <cstdint>
#include <vector>

namespace vera::detail {

/// The main scene's geometry or a subscene's, and its local coordinates, in which an index is
/// made: `center` moved to 0 and all multiplied by `scale`, a power of two that makes the bounds
/// fit into [-1, 1]. So single precision is good for what only prunes, and a scene and its copy in
/// another unit of length behave alike.
struct LocalGeometry {
    const Geometry* geometry = nullptr;
    Box3 bounds; ///< of what rays can meet, in the geometry's own coordinates; empty where nothing
    Vec3 center;
    double scale = 1;
    Box3 local_bounds;
    double coordinate_size = 0; ///< the largest that says where anything lies, in scene units
    /// Of a geometry that is one mesh: Mesh::position_indices, for what asks for them early.
    const std::uint32_t* mesh_corners = nullptr;
    OutlineTable outlines; ///< made by the index, for the tests that decide
};

inline Vec3 local_point(const LocalGeometry& local, Vec3 point) {
    return local.scale * (point - local.center);
}

/// The point of local coordinates in the geometry's own.
inline Vec3 own_point(const LocalGeometry& local, Vec3 point) {
    return (1 / local.scale) * point + local.center;
}

/// The geometry with its local coordinates chosen, given the bounds of the subscenes.
LocalGeometry local_geometry(const Geometry& geometry, const std::vector<Box3>& subscene_bounds);

/// Bounds of an element in local coordinates; empty for a call of an empty subscene.
Box3 local_box(
    const LocalGeometry& local, Element element, const std::vector<Box3>& subscene_bounds);

} // namespace vera::detail
