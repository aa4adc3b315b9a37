// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/box3.h"
#include "vera/math/ray.h"
#include "vera/math/vec3.h"

#include <array>
#include <optional>

namespace vera {

/// A linear map: rows of a 3 x 3 matrix.
struct Matrix3 {
    std::array<Vec3, 3> rows = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

    friend constexpr bool operator==(const Matrix3&, const Matrix3&) = default;
};

constexpr Vec3 operator*(const Matrix3& m, Vec3 a) {
    return {dot(m.rows[0], a), dot(m.rows[1], a), dot(m.rows[2], a)};
}

/// An affine map: points go to linear * point + translation. The default changes nothing.
struct Affine3 {
    Matrix3 linear;
    Vec3 translation;

    friend constexpr bool operator==(const Affine3&, const Affine3&) = default;
};

constexpr Vec3 transformed_point(const Affine3& map, Vec3 point) {
    return map.linear * point + map.translation;
}

constexpr Vec3 transformed_vector(const Affine3& map, Vec3 vector) {
    return map.linear * vector;
}

/// The transposed matrix of the map times the covector: applied to the inverse map, this carries
/// normals. The result is not made unit.
constexpr Vec3 transposed_times(const Matrix3& m, Vec3 a) {
    return a.x * m.rows[0] + a.y * m.rows[1] + a.z * m.rows[2];
}

Matrix3 transposed(const Matrix3& m);
double determinant(const Matrix3& m);

/// First inner, then outer.
Affine3 composed(const Affine3& outer, const Affine3& inner);

/// Nothing when the map is singular: when its determinant is 0 or too small to divide by, compared
/// with the lengths of its rows.
std::optional<Affine3> inverse(const Affine3& map);

Affine3 scaling(double factor);
Affine3 translation(Vec3 offset);

/// Turns by x degrees about the x axis, then by y about y, then by z about z, all right-handed.
Affine3 rotation(Vec3 angles_degrees);

/// A box that holds the image of the box, rounding included; empty for an empty one.
Box3 transformed_box(const Affine3& map, const Box3& box);

/// The ray in the other coordinates, with the same t. Its origin_error covers that of the ray, the
/// rounding here, and that of a map which was itself computed, as an inverse is.
Ray transformed_ray(const Affine3& map, const Ray& ray);

} // namespace vera
