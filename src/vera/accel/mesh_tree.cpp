// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/mesh_tree.h"

#include "vera/accel/float_tree_build.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

namespace vera::detail {

namespace {

using Corners = std::array<std::uint32_t, 3>;

/// Lowers the bound to the value.
void lower(std::atomic<std::size_t>& bound, std::size_t value) {
    std::size_t before = bound.load();
    while (value < before && !bound.compare_exchange_weak(before, value)) {
    }
}

void check_corners(const MeshSpans& mesh) {
    const std::size_t vertices = mesh.vertices.size();
    std::atomic<std::size_t> first_wrong = mesh.triangles.size();
    parallel_ranges(
        mesh.triangles.size(), float_tree_grain, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                const Corners& corners = mesh.triangles[i];
                if (corners[0] >= vertices || corners[1] >= vertices || corners[2] >= vertices)
                    return lower(first_wrong, i);
            }
        });
    const std::size_t i = first_wrong;
    if (i == mesh.triangles.size())
        return;
    const Corners& corners = mesh.triangles[i];
    std::size_t corner = 0;
    while (corners[corner] < vertices)
        ++corner;
    throw std::invalid_argument(fmt::format(
        "corner {} of triangle {} is vertex {}, but there are only {} vertices, numbered from 0",
        corner,
        i,
        corners[corner],
        vertices));
}

/// The largest coordinate of the corners, without its sign; 0 where one is not finite, as such a
/// triangle is left out.
float size_of(const MeshSpans& mesh, const Corners& corners) {
    // Without the sign, bits have the order of the numbers, and those that are not finite come
    // last.
    std::uint32_t bits = 0;
    for (const std::uint32_t corner : corners)
        for (const float coordinate : mesh.vertices[corner])
            bits = std::max(bits, std::bit_cast<std::uint32_t>(coordinate) & 0x7fffffffU);
    const auto size = std::bit_cast<float>(bits);
    return std::isfinite(size) ? size : 0;
}

/// Whether the coordinates of all triangles that are not left out can be had back. Mostly they can
/// of all vertices, which is sooner known.
bool scale_exactly(const MeshSpans& mesh, const FloatTree& tree) {
    const auto is_exact = [&](std::size_t vertex) {
        return scales_exactly(tree, mesh.vertices[vertex]);
    };
    return holds_for_all(mesh.vertices.size(), is_exact)
        || holds_for_all(mesh.triangles.size(), [&](std::size_t i) {
               const Corners& corners = mesh.triangles[i];
               return size_of(mesh, corners) == 0
                   || std::all_of(corners.begin(), corners.end(), is_exact);
           });
}

/// The box of the corners, scaled; empty where a coordinate is not finite.
FloatBox box_of(const MeshSpans& mesh, const Corners& corners, const FloatScale& scale) {
    FloatBox box;
    for (const std::uint32_t corner : corners)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float coordinate = mesh.vertices[corner][axis];
            if (!std::isfinite(coordinate))
                return {};
            box.lower[axis] = std::min(box.lower[axis], scale(coordinate));
            box.upper[axis] = std::max(box.upper[axis], scale(coordinate));
        }
    return box;
}

/// The areas of the triangles: half of the surface of their two sides. Those that cannot be met may
/// be no numbers.
std::vector<float> areas(const MeshSpans& mesh, const FloatScale& scale) {
    std::vector<float> areas(mesh.triangles.size());
    parallel_ranges(areas.size(), float_tree_grain, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const auto& [a, b, c] = mesh.triangles[i];
            float e[3];
            float f[3];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const float corner = scale(mesh.vertices[a][axis]);
                e[axis] = scale(mesh.vertices[b][axis]) - corner;
                f[axis] = scale(mesh.vertices[c][axis]) - corner;
            }
            const float x = e[1] * f[2] - e[2] * f[1];
            const float y = e[2] * f[0] - e[0] * f[2];
            const float z = e[0] * f[1] - e[1] * f[0];
            areas[i] = 0.5F * std::sqrt(x * x + y * y + z * z);
        }
    });
    return areas;
}

} // namespace

MeshTree build_mesh_tree(MeshSpans mesh, MeshIndexQuality quality, const CancelFlag* cancel) {
    if (mesh.triangles.size() >= TreeChild::most)
        throw std::length_error(fmt::format(
            "a mesh of {} triangles is more than one index can number; make several of at most {}",
            mesh.triangles.size(),
            TreeChild::most - 1));
    check_corners(mesh);
    MeshTree tree;
    tree.mesh = mesh;
    const float largest = largest_size(
        mesh.triangles.size(), [&](std::size_t i) { return size_of(mesh, mesh.triangles[i]); });
    set_scale(tree, static_cast<double>(largest));
    tree.exact = scale_exactly(mesh, tree);
    std::vector<BoxReference> references =
        float_references(mesh.triangles.size(), [&](std::size_t i) {
            return box_of(mesh, mesh.triangles[i], tree.scale);
        });
    const std::size_t triangles = references.size();
    const std::size_t leaves = grow_float_tree(
        tree,
        std::move(references),
        quality,
        cancel,
        areas(mesh, tree.scale),
        [&](std::uint32_t triangle) {
            CornerNumbers numbers = corner_numbers(mesh, triangle);
            for (float& number : numbers)
                number = tree.scale(number);
            return numbers;
        });
    tree.statistics = {
        triangles,
        mesh.triangles.size() - triangles,
        tree.levels,
        tree.nodes.size(),
        leaves,
        bytes_of(tree)};
    return tree;
}

} // namespace vera::detail
