// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/mesh_tree.h"

#include "vera/base/large_pages.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace vera::detail {

namespace {

/// Ranges that the threads take.
constexpr std::size_t grain = 4096;

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
    parallel_ranges(mesh.triangles.size(), grain, [&](std::size_t first, std::size_t last) {
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

/// The largest coordinate of the finite vertices, without its sign.
float largest_coordinate(std::span<const std::array<float, 3>> vertices) {
    std::atomic<std::uint32_t> largest = 0; // of positive numbers, the bits have the same order
    parallel_ranges(vertices.size(), grain, [&](std::size_t first, std::size_t last) {
        float of_part = 0;
        for (std::size_t i = first; i < last; ++i)
            for (const float coordinate : vertices[i])
                if (std::isfinite(coordinate))
                    of_part = std::max(of_part, std::abs(coordinate));
        const auto bits = std::bit_cast<std::uint32_t>(of_part);
        std::uint32_t before = largest.load();
        while (before < bits && !largest.compare_exchange_weak(before, bits)) {
        }
    });
    return std::bit_cast<float>(largest.load());
}

/// The box of the corners; empty where a coordinate is not finite.
FloatBox box_of(const MeshSpans& mesh, const Corners& corners, const MeshScale& scale) {
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

/// Every coordinate can be had back from what it becomes.
bool is_exact(const MeshSpans& mesh, int exponent) {
    const MeshScale scale(exponent);
    const MeshScale back(-exponent);
    std::atomic<bool> exact = true;
    parallel_ranges(mesh.vertices.size(), grain, [&](std::size_t first, std::size_t last) {
        bool all = true;
        for (std::size_t i = first; i < last; ++i)
            for (const float coordinate : mesh.vertices[i])
                all = all && (back(scale(coordinate)) == coordinate || !std::isfinite(coordinate));
        if (!all)
            exact = false;
    });
    return exact;
}

std::vector<BoxReference> references_of(const MeshSpans& mesh, const MeshScale& scale) {
    std::vector<BoxReference> references(mesh.triangles.size());
    std::atomic<bool> some_are_empty = false;
    parallel_ranges(references.size(), grain, [&](std::size_t first, std::size_t last) {
        bool empty = false;
        for (std::size_t i = first; i < last; ++i) {
            const FloatBox box = box_of(mesh, mesh.triangles[i], scale);
            references[i] = {box.lower, static_cast<std::uint32_t>(i), box.upper, 0};
            empty = empty || !(box.lower[0] <= box.upper[0]);
        }
        if (empty)
            some_are_empty = true;
    });
    if (some_are_empty)
        std::erase_if(references, [](const BoxReference& reference) {
            return !(reference.lower[0] <= reference.upper[0]);
        });
    return references;
}

/// Fills in the rows of a leaf.
void fill_leaf(
    const MeshSpans& mesh,
    const MeshScale& scale,
    const std::vector<BoxReference>& references,
    const TreeChild& leaf,
    std::vector<float>& leaves) {
    const std::size_t size = leaf_size(leaf);
    float* const rows = leaves.data() + mesh_leaf_rows * leaf.first();
    for (std::size_t i = 0; i < size; ++i) {
        const std::uint32_t number = references[leaf.first() + i].element;
        for (std::size_t corner = 0; corner < 3; ++corner)
            for (std::size_t axis = 0; axis < 3; ++axis)
                rows[(3 * corner + axis) * size + i] =
                    scale(mesh.vertices[mesh.triangles[number][corner]][axis]);
        rows[mesh_number_row * size + i] = std::bit_cast<float>(number);
    }
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
    const float largest = largest_coordinate(mesh.vertices);
    if (largest > 0) {
        int exponent = 0;
        std::frexp(largest, &exponent);
        tree.exponent = -exponent;
    }
    tree.scale = MeshScale(tree.exponent);
    tree.scale_back = MeshScale(-tree.exponent);
    const MeshScale& scale = tree.scale;
    tree.exact = is_exact(mesh, tree.exponent);
    std::vector<BoxReference> references = references_of(mesh, scale);
    const std::size_t triangles = references.size();
    const TreeEffort effort =
        quality == MeshIndexQuality::high ? TreeEffort::high : TreeEffort::usual;
    BoxTree boxes = build_box_tree(std::move(references), mesh_leaf_size, cancel, effort);
    // Whole registers are loaded of the last rows.
    const std::size_t numbers = mesh_leaf_rows * boxes.references.size() + 2 * mesh_leaf_size;
    tree.leaves.reserve(numbers);
    prefer_large_pages(tree.leaves.data(), numbers * sizeof(float));
    tree.leaves.resize(numbers);
    parallel_ranges(boxes.nodes.size(), 256, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            for (const TreeChild& child : boxes.nodes[i].children)
                if (child.is_block() != 0)
                    fill_leaf(mesh, scale, boxes.references, child, tree.leaves);
    });
    tree.nodes = std::move(boxes.nodes);
    prefer_large_pages(tree.nodes.data(), tree.nodes.size() * sizeof(WideNode));
    tree.statistics = {
        triangles,
        mesh.triangles.size() - triangles,
        boxes.levels,
        tree.nodes.size(),
        boxes.leaves,
        sizeof(MeshTree) + tree.nodes.capacity() * sizeof(WideNode)
            + tree.leaves.capacity() * sizeof(float)};
    return tree;
}

} // namespace vera::detail
