// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/leaf.h"

#include "vera/generate/scene_parts.h"
#include "vera/math/elementary.h"

#include <cmath>

namespace vera {

namespace {

/// Place of the blade at `along`, from stalk to tip, and `across`, from -1 at one margin to 1 at
/// the other.
Vec3 blade_place(const LeafForm& form, double along, double across) {
    // A power of t and one of 1 - t whose product is largest, 1, at the widest place.
    const double first = 0.75;
    const double second = first * (1 - form.widest) / form.widest;
    const double shape =
        power(along / form.widest, first) * power((1 - along) / (1 - form.widest), second);
    const double x = form.half_width * shape * across;
    const double wave = form.waves * across * across * sin_degrees(360 * 5 * along);
    // The veins: shallow furrows that run from the midrib outwards and forwards.
    const double vein = 0.002 * shape * sin_degrees(360 * 22 * (along - 0.12 * std::abs(across)));
    const double rise = form.fold * std::abs(x) * (1 - 0.5 * std::abs(across));
    return {x, along, rise - form.droop * along * along + shape * wave + vein};
}

} // namespace

Mesh leaf_blade(const LeafForm& form) {
    Mesh mesh;
    const std::size_t width = 2 * form.columns + 1;
    for (std::size_t row = 0; row <= form.rows; ++row)
        for (std::size_t column = 0; column < width; ++column)
            mesh.positions.push_back(short_decimals(blade_place(
                form,
                static_cast<double>(row) / static_cast<double>(form.rows),
                static_cast<double>(column) / static_cast<double>(form.columns) - 1)));
    mesh.normals.resize(mesh.positions.size());
    const auto add_triangle = [&](std::size_t a, std::size_t b, std::size_t c) {
        const Vec3 area =
            cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
        // At both ends a row is one point.
        if (!(length(area) > 1e-12))
            return;
        for (const std::size_t corner : {a, b, c}) {
            mesh.position_indices.push_back(static_cast<std::uint32_t>(corner));
            mesh.normals[corner] = mesh.normals[corner] + area;
        }
    };
    for (std::size_t row = 0; row < form.rows; ++row)
        for (std::size_t column = 0; column + 1 < width; ++column) {
            const std::size_t corner = row * width + column;
            // Diagonals go forwards from the midrib, as veins do.
            if (column < form.columns) {
                add_triangle(corner, corner + 1, corner + width);
                add_triangle(corner + 1, corner + width + 1, corner + width);
            } else {
                add_triangle(corner, corner + 1, corner + width + 1);
                add_triangle(corner, corner + width + 1, corner + width);
            }
        }
    for (Vec3& normal : mesh.normals)
        normal = short_decimals(normalized(normal));
    return mesh;
}

} // namespace vera
