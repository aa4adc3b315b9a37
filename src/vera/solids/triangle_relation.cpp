// SPDX-License-Identifier: Apache-2.0
#include "vera/solids/triangle_relation.h"

#include "vera/exact/orientation.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

namespace vera {

namespace {

/// On which sides of a plane the corners of a triangle lie.
using Sides = std::array<int, 3>;

Sides sides_of(const TriangleCorners& triangle, const TriangleCorners& plane) {
    Sides sides;
    for (std::size_t i = 0; i < 3; ++i)
        sides[i] = std::ranges::find(plane, triangle[i]) != plane.end()
            ? 0
            : orientation(plane[0], plane[1], plane[2], triangle[i]);
    return sides;
}

bool lies_through(const Sides& sides) {
    return std::ranges::find(sides, 1) != sides.end()
        && std::ranges::find(sides, -1) != sides.end();
}

/// A triangle, and on which sides of the other's plane its corners lie.
struct CutTriangle {
    TriangleCorners corners;
    Sides sides;
};

/// Turns the triangle so that its first corner lies alone on its side of the other's plane, and the
/// other over, where that side is not the one of its normal.
void stand_first_alone(CutTriangle& triangle, CutTriangle& other) {
    const int alone = std::ranges::count(triangle.sides, 1) == 1 ? 1 : -1;
    while (triangle.sides[0] != alone) {
        std::rotate(triangle.corners.begin(), triangle.corners.begin() + 1, triangle.corners.end());
        std::rotate(triangle.sides.begin(), triangle.sides.begin() + 1, triangle.sides.end());
    }
    if (alone < 0) {
        std::swap(other.corners[1], other.corners[2]);
        std::swap(other.sides[1], other.sides[2]);
    }
}

/// Of triangles that each lie through the other's plane: whether the parts that they have of the
/// planes' common line overlap (Guigue and Devillers 2003).
bool overlap_on_line(CutTriangle a, CutTriangle b) {
    stand_first_alone(a, b);
    stand_first_alone(b, a);
    const TriangleCorners& p = a.corners;
    const TriangleCorners& q = b.corners;
    return orientation(p[0], p[1], q[0], q[1]) < 0 && orientation(p[0], p[2], q[2], q[0]) < 0;
}

/// An axis along which the triangle is seen as an area, and from which side.
struct View {
    std::size_t axis = 0;
    int side = 1;
};

std::optional<View> view_of(const TriangleCorners& triangle) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (const int side = orientation_along(axis, triangle[0], triangle[1], triangle[2]))
            return View{axis, side};
    return std::nullopt;
}

/// Whether one of the triangle's sides has all of the other beyond it.
bool has_beyond(const TriangleCorners& triangle, View view, const TriangleCorners& other) {
    for (std::size_t i = 0; i < 3; ++i)
        if (std::ranges::all_of(other, [&](Vec3 corner) {
                return view.side
                    * orientation_along(view.axis, triangle[i], triangle[(i + 1) % 3], corner)
                    <= 0;
            }))
            return true;
    return false;
}

bool cover(const TriangleCorners& a, const TriangleCorners& b) {
    const auto view_a = view_of(a);
    if (!view_a)
        return false;
    const View view_b = {view_a->axis, orientation_along(view_a->axis, b[0], b[1], b[2])};
    return view_b.side != 0 && !has_beyond(a, *view_a, b) && !has_beyond(b, view_b, a);
}

} // namespace

TriangleRelation relation(const TriangleCorners& a, const TriangleCorners& b) {
    const Sides sides_a = sides_of(a, b);
    if (sides_a == Sides{0, 0, 0})
        return cover(a, b) ? TriangleRelation::covering : TriangleRelation::apart;
    if (!lies_through(sides_a))
        return TriangleRelation::apart;
    const Sides sides_b = sides_of(b, a);
    return lies_through(sides_b) && overlap_on_line({a, sides_a}, {b, sides_b})
        ? TriangleRelation::crossing
        : TriangleRelation::apart;
}

} // namespace vera
