// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/vec3.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace vera {

/// SP x y z radius
struct Sphere {
    Vec3 center;
    double radius = 1;
};

/// P3 p1 p2 p3. Its normal is (p2-p1) x (p3-p1).
struct Triangle {
    std::array<Vec3, 3> corners;
};

/// PA p1 p2 p3 n1 n2 n3: a triangle whose normals are interpolated, as given, between its corners.
struct Patch {
    std::array<Vec3, 3> corners;
    std::array<Vec3, 3> normals;
};

/// P4 p1 p2 p3 p4 | PN n p1 ... pn: a simple polygon, its corners Geometry::corners[first_corner]
/// and those that follow. Its normal is its area vector.
struct Polygon {
    enum class Shape : std::uint8_t {
        convex,          ///< plane
        simple,          ///< plane, not convex
        split_quadrangle ///< not plane: piece 0 is p1 p2 p3, piece 1 is p1 p3 p4
    };

    std::uint32_t first_corner = 0;
    std::uint32_t corner_count = 0;
    Shape shape = Shape::convex;
    Vec3 normal; ///< unit; of a split quadrangle, not used
};

/// A piece of a contour, in distances (r, h) from the axis and along it. It starts where the piece
/// before it ends.
struct ContourPiece {
    enum class Kind : std::uint8_t {
        line,  ///< GE: straight to end
        conic, ///< arcs of circles and conics: a rational quadratic curve, with control[0] and
               ///< weight
        cubic  ///< a cubic Bezier curve with control[0] and control[1]
    };

    struct Point {
        double r = 0;
        double h = 0;

        friend constexpr bool operator==(const Point&, const Point&) = default;
    };

    Kind kind = Kind::line;
    std::array<Point, 2> control = {};
    double weight = 1; ///< of control[0]; the ends have weight 1; > 0
    Point end;
};

/// RS | RK base P tip | V direction, then AN r h {GE r h | ...}
/// Piece i of the contour is piece i of the shape. The outer side of a piece that goes by (dr, dh)
/// is the side of (dh, -dr). All r >= 0, along the curves as well.
struct RotationalShape {
    Vec3 base;
    Vec3 axis = {0, 0, 1}; ///< unit
    ContourPiece::Point start;
    std::vector<ContourPiece> contour;
};

/// MESH "file": triangles with shared corners. Corner c of triangle i is
/// positions[position_indices[3 i + c]]. With normals, the triangles are patches; normal_indices is
/// then as long as position_indices, or empty where both are the same. Each triangle is a
/// primitive.
struct Mesh {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> position_indices;
    std::vector<Vec3> normals;
    std::vector<std::uint32_t> normal_indices;

    std::size_t triangle_count() const { return position_indices.size() / 3; }
};

} // namespace vera
