// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// The triangles and spheres of a scene in single precision, as Embree and the index of a mesh read
/// them. Both refer to them, as our other indexes refer to the scene.
struct FloatGeometry {
    /// And one more than the triangles name: Embree reads four numbers at a time.
    std::vector<std::array<float, 3>> corners;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::array<float, 4>> spheres; ///< center and radius
};

/// Rotational shapes, which Embree has none of, become so many flat sides, and each of their curves
/// so many pieces.
struct Facets {
    std::size_t sides = 128;
    std::size_t pieces = 48;
};

/// Throws std::runtime_error for a scene with subscenes, or polygons that are not convex.
FloatGeometry float_geometry(const Scene& scene, const Facets& facets = {});

} // namespace vera
