// SPDX-License-Identifier: Apache-2.0
#include "vera/math/transform.h"

#include "vera/math/elementary.h"

#include <cmath>

namespace vera {

Matrix3 transposed(const Matrix3& m) {
    return {
        {Vec3{m.rows[0].x, m.rows[1].x, m.rows[2].x},
         Vec3{m.rows[0].y, m.rows[1].y, m.rows[2].y},
         Vec3{m.rows[0].z, m.rows[1].z, m.rows[2].z}}};
}

double determinant(const Matrix3& m) {
    return dot(m.rows[0], cross(m.rows[1], m.rows[2]));
}

namespace {

Matrix3 product(const Matrix3& outer, const Matrix3& inner) {
    Matrix3 result;
    for (std::size_t i = 0; i < 3; ++i)
        result.rows[i] = transposed_times(inner, outer.rows[i]);
    return result;
}

} // namespace

Affine3 composed(const Affine3& outer, const Affine3& inner) {
    return {product(outer.linear, inner.linear), transformed_point(outer, inner.translation)};
}

std::optional<Affine3> inverse(const Affine3& map) {
    // Rows are made of length about 1 first, by powers of two, so that a map in any unit of length
    // is judged alike and nothing overflows.
    Matrix3 scaled = map.linear;
    std::array<int, 3> exponents = {};
    for (std::size_t i = 0; i < 3; ++i) {
        const double largest = max_component(abs(scaled.rows[i]));
        if (!(largest > 0) || !std::isfinite(largest))
            return std::nullopt;
        std::frexp(largest, &exponents[i]);
        for (std::size_t axis = 0; axis < 3; ++axis)
            scaled.rows[i][axis] = std::ldexp(scaled.rows[i][axis], -exponents[i]);
    }
    const double volume = determinant(scaled);
    // The three products of the determinant are each rounded by at most 3 units of 2^-53 of values
    // below 2: below this bound its sign is noise.
    constexpr double smallest_volume = 0x1p-46;
    if (!(std::abs(volume) > smallest_volume))
        return std::nullopt;

    // Column i of the inverse is the cross product of the other two rows over the volume.
    const auto& [a, b, c] = scaled.rows;
    std::array<Vec3, 3> columns = {
        cross(b, c) / volume, cross(c, a) / volume, cross(a, b) / volume};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            columns[i][axis] = std::ldexp(columns[i][axis], -exponents[i]);
    Affine3 result;
    result.linear = transposed({columns});
    result.translation = -(result.linear * map.translation);
    if (!is_finite(result.translation))
        return std::nullopt;
    for (const Vec3& row : result.linear.rows)
        if (!is_finite(row))
            return std::nullopt;
    return result;
}

Affine3 scaling(double factor) {
    return {{{Vec3{factor, 0, 0}, Vec3{0, factor, 0}, Vec3{0, 0, factor}}}, {}};
}

Affine3 translation(Vec3 offset) {
    return {{}, offset};
}

Affine3 rotation(Vec3 angles_degrees) {
    const auto turn = [](double angle_degrees, std::size_t from, std::size_t to) {
        const double cosine = cos_degrees(angle_degrees);
        const double sine = sin_degrees(angle_degrees);
        Affine3 map;
        map.linear.rows[from][from] = cosine;
        map.linear.rows[from][to] = -sine;
        map.linear.rows[to][from] = sine;
        map.linear.rows[to][to] = cosine;
        return map;
    };
    const Affine3 about_x = turn(angles_degrees.x, 1, 2);
    const Affine3 about_y = turn(angles_degrees.y, 2, 0);
    const Affine3 about_z = turn(angles_degrees.z, 0, 1);
    return composed(about_z, composed(about_y, about_x));
}

Box3 transformed_box(const Affine3& map, const Box3& box) {
    if (box.empty())
        return {};
    Box3 result;
    for (unsigned i = 0; i < 8; ++i)
        result = grown(result, transformed_point(map, corner(box, i)));
    const Vec3 farthest = max(abs(box.lower), abs(box.upper));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // Three products and three sums: at most 4 roundings of the sum of the sizes.
        const double error =
            0x1p-50 * (dot(abs(map.linear.rows[axis]), farthest) + std::abs(map.translation[axis]));
        result.lower[axis] -= error;
        result.upper[axis] += error;
    }
    return result;
}

Ray transformed_ray(const Affine3& map, const Ray& ray) {
    Ray result = ray;
    result.origin = transformed_point(map, ray.origin);
    result.direction = transformed_vector(map, ray.direction);
    double error = 0;
    const Vec3 size = abs(ray.origin);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Vec3 row = abs(map.linear.rows[axis]);
        // Products, sums and the map's own rounding: well below 2^4 units of the sum of the sizes.
        const double here = 0x1p-48 * (dot(row, size) + std::abs(map.translation[axis]))
            + ray.origin_error * (row.x + row.y + row.z);
        error = here > error ? here : error;
    }
    result.origin_error = error;
    return result;
}

} // namespace vera
