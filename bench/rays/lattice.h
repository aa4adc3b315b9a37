// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/random.h"
#include "vera/math/vec3.h"
#include "vera/scene/primitives.h"

#include <cstddef>
#include <cstdint>

namespace vera {

/// From 0 to 1, 1 excluded; depends on the three numbers and on nothing else.
inline double random_part(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample) {
    return static_cast<double>(random(seed, pixel, sample) >> 11) * 0x1p-53;
}

inline std::uint32_t add_corner(Mesh& mesh, Vec3 point) {
    mesh.positions.push_back(point);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

inline void add_triangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.position_indices.insert(mesh.position_indices.end(), {a, b, c});
}

/// Adds across times up quadrangles, two triangles each, through the points point(i, j), i from 0
/// to across and j from 0 to up.
template <typename Point>
void add_lattice(Mesh& mesh, std::size_t across, std::size_t up, const Point& point) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto row = static_cast<std::uint32_t>(across + 1);
    for (std::size_t j = 0; j <= up; ++j)
        for (std::size_t i = 0; i <= across; ++i)
            add_corner(mesh, point(i, j));
    for (std::uint32_t j = 0; j < up; ++j)
        for (std::uint32_t i = 0; i < across; ++i) {
            const std::uint32_t a = first + j * row + i;
            add_triangle(mesh, a, a + 1, a + row + 1);
            add_triangle(mesh, a, a + row + 1, a + row);
        }
}

} // namespace vera
