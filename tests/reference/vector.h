// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/color.h"
#include "vera/math/transform.h"
#include "vera/math/vec3.h"

#include <array>
#include <cmath>

/// The reference renderer: the language's rules written down once more, slowly and plainly, with
/// nothing of the renderer's own arithmetic, so that the two can be compared. Of the library it
/// knows the Scene and nothing else.
namespace vera::reference {

/// More digits than the renderer has, where the machine has them.
using Real = long double;

/// A point, a direction or a colour.
struct Vector {
    Real x = 0;
    Real y = 0;
    Real z = 0;
};

inline Vector vector_of(Vec3 a) {
    return {a.x, a.y, a.z};
}

inline Vector vector_of(Color a) {
    return {a.r, a.g, a.b};
}

inline Vector operator+(Vector a, Vector b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

inline Vector operator-(Vector a, Vector b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

inline Vector operator*(Real factor, Vector a) {
    return {factor * a.x, factor * a.y, factor * a.z};
}

/// Colour by colour.
inline Vector filtered(Vector a, Vector b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

inline Real inner(Vector a, Vector b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline Vector outer(Vector a, Vector b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline Real norm(Vector a) {
    return std::sqrt(inner(a, a));
}

inline Vector unit(Vector a) {
    return (1 / norm(a)) * a;
}

/// The largest coordinate's size: what rounding errors are measured by.
inline Real size(Vector a) {
    return std::fmax(std::fabs(a.x), std::fmax(std::fabs(a.y), std::fabs(a.z)));
}

inline bool is_black(Vector a) {
    return a.x == 0 && a.y == 0 && a.z == 0;
}

/// Where a subscene's points go: columns of a matrix (the images of the axes), and a shift.
struct Placement {
    std::array<Vector, 3> columns = {Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}};
    Vector shift;
};

inline Vector turned(const Placement& placement, Vector a) {
    return a.x * placement.columns[0] + a.y * placement.columns[1] + a.z * placement.columns[2];
}

inline Vector placed(const Placement& placement, Vector a) {
    return turned(placement, a) + placement.shift;
}

inline Placement placement_of(const Affine3& map) {
    const auto& rows = map.linear.rows;
    return {
        {Vector{rows[0].x, rows[1].x, rows[2].x},
         Vector{rows[0].y, rows[1].y, rows[2].y},
         Vector{rows[0].z, rows[1].z, rows[2].z}},
        vector_of(map.translation)};
}

/// First the second, then the first.
inline Placement chained(const Placement& first, const Placement& second) {
    Placement result;
    for (std::size_t i = 0; i < 3; ++i)
        result.columns[i] = turned(first, second.columns[i]);
    result.shift = placed(first, second.shift);
    return result;
}

/// The volume that the unit cube gets; negative when the placement mirrors.
inline Real volume(const Placement& placement) {
    return inner(placement.columns[0], outer(placement.columns[1], placement.columns[2]));
}

/// How much a length may grow at most, or a little more.
inline Real stretch(const Placement& placement) {
    Real sum = 0;
    for (const Vector& column : placement.columns)
        sum += inner(column, column);
    return std::sqrt(sum);
}

/// Carries normals: the inverse transpose, whose columns are the cofactors over the volume.
inline Vector carried_normal(const Placement& placement, Vector normal) {
    const auto& [a, b, c] = placement.columns;
    const Vector sum = normal.x * outer(b, c) + normal.y * outer(c, a) + normal.z * outer(a, b);
    return (1 / volume(placement)) * sum;
}

/// The vector that the placement turns into a (Cramer's rule).
inline Vector turned_back(const Placement& placement, Vector a) {
    const auto& [p, q, r] = placement.columns;
    const Real whole = volume(placement);
    return {
        inner(a, outer(q, r)) / whole,
        inner(p, outer(a, r)) / whole,
        inner(p, outer(q, a)) / whole};
}

inline Vector placed_back(const Placement& placement, Vector a) {
    return turned_back(placement, a - placement.shift);
}

} // namespace vera::reference
