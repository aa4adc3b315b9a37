// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/primitives.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace vera {

/// A curved primitive as plane triangles in its own coordinates, counterclockwise from outside.
/// Neighbours share their corners by number.
struct CurvedFacets {
    struct Triangle {
        std::array<std::uint32_t, 3> corners = {};
        std::uint32_t piece = 0;
    };

    std::vector<Vec3> corners;
    std::vector<Triangle> triangles;
};

/// How far from the surface a facet may lie near a point, in the primitive's own coordinates.
using LocalDeviation = std::function<double(Vec3)>;

/// An octahedron whose triangles are divided until they are near enough: finer only where it is
/// asked for.
CurvedFacets curved_facets(const Sphere& sphere, const LocalDeviation& deviation, std::size_t most);

/// Bands between circles about the axis, at most `most` triangles in all. Nothing of pieces that
/// hold no area.
CurvedFacets
curved_facets(const RotationalShape& shape, const LocalDeviation& deviation, std::size_t most);

} // namespace vera
