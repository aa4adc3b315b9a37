// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/geometry.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// The plane faces and patches of one geometry, each triangle of a mesh a face, as they join:
/// corners of the same coordinates are the same point. Curved primitives and subscenes are left
/// out.
struct SolidFaces {
    struct Face {
        std::uint32_t item = 0;
        std::uint32_t first_corner = 0;
        std::uint32_t corner_count = 0;
    };

    /// A face is made of one or more.
    struct Triangle {
        std::array<std::uint32_t, 3> points = {};
        std::uint32_t face = 0;
    };

    std::vector<Vec3> points;
    std::vector<std::uint32_t> corners; ///< points, in the order of each face's text
    std::vector<Face> faces;            ///< in text order
    std::vector<Triangle> triangles;    ///< in the order of their faces

    std::span<const std::uint32_t> corners_of(const Face& face) const {
        return std::span(corners).subspan(face.first_corner, face.corner_count);
    }

    std::array<Vec3, 3> corners_of(const Triangle& triangle) const {
        return {points[triangle.points[0]], points[triangle.points[1]], points[triangle.points[2]]};
    }
};

/// Throws InputError where the geometry has 2^32 corners or more.
SolidFaces solid_faces(const Geometry& geometry);

} // namespace vera
