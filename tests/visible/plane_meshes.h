// SPDX-License-Identifier: Apache-2.0
// Meshes whose triangles lie in few planes.
#pragma once

#include "vera/scene/primitives.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>

namespace vera::testing {

inline std::size_t below(std::mt19937& random, std::size_t count) {
    return random() % count;
}

inline void add_triangle(Mesh& mesh, std::array<std::size_t, 3> corners) {
    for (const std::size_t corner : corners)
        mesh.position_indices.push_back(static_cast<std::uint32_t>(corner));
}

/// A field of squares of two triangles each, at heights of few values, some squares twice, turned
/// over or without an area.
inline Mesh random_field(std::mt19937& random, std::size_t side, std::size_t heights) {
    Mesh mesh;
    for (std::size_t y = 0; y <= side; ++y)
        for (std::size_t x = 0; x <= side; ++x)
            mesh.positions.push_back(
                {static_cast<double>(x),
                 static_cast<double>(y),
                 static_cast<double>(below(random, heights))});
    for (std::size_t y = 0; y < side; ++y)
        for (std::size_t x = 0; x < side; ++x) {
            const std::size_t a = y * (side + 1) + x;
            const std::array<std::size_t, 4> round = {a, a + 1, a + side + 2, a + side + 1};
            const std::size_t from = below(random, 2);
            const auto corner = [&](std::size_t i) { return round[(from + i) % 4]; };
            const std::size_t kind = below(random, 12);
            add_triangle(mesh, {corner(0), corner(1), corner(2)});
            if (kind == 0)
                add_triangle(mesh, {corner(0), corner(3), corner(2)});
            else
                add_triangle(mesh, {corner(0), corner(2), corner(3)});
            if (kind == 1)
                add_triangle(mesh, {corner(2), corner(3), corner(0)});
            if (kind == 2)
                add_triangle(mesh, {corner(0), corner(2), corner(0)});
        }
    return mesh;
}

/// Twelve triangles.
inline Mesh cube() {
    Mesh mesh;
    for (std::size_t i = 0; i < 8; ++i)
        mesh.positions.push_back(
            {(i & 4U) == 0 ? -1.0 : 1.0, (i & 2U) == 0 ? -1.0 : 1.0, (i & 1U) == 0 ? -1.0 : 1.0});
    const std::array<std::array<std::size_t, 4>, 6> sides = {
        {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}};
    for (const auto& [a, b, c, d] : sides) {
        add_triangle(mesh, {a, b, c});
        add_triangle(mesh, {a, c, d});
    }
    return mesh;
}

} // namespace vera::testing
