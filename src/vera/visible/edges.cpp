// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/edges.h"

#include <algorithm>
#include <cstddef>

namespace vera {

void add_edges(
    const ScreenScene& scene,
    std::size_t first_triangle,
    std::size_t first_vertex,
    ScreenEdges& edges) {
    struct Side {
        std::uint32_t end;
        std::uint32_t triangle;
        std::uint32_t number; ///< of the side in its triangle
    };

    // In groups by their first vertex, which are short.
    std::vector<std::uint32_t> starts(scene.vertices.size() - first_vertex + 1);
    const auto for_each_side = [&](const auto& visit) {
        for (auto i = static_cast<std::uint32_t>(first_triangle); i < scene.triangles.size(); ++i)
            for (std::uint32_t side = 0; side < 3; ++side) {
                const auto& vertices = scene.triangles[i].vertices;
                const std::uint32_t from = vertices[side];
                const std::uint32_t to = vertices[(side + 1) % 3];
                visit(std::min(from, to) - first_vertex, Side{std::max(from, to), i, side});
            }
    };
    for_each_side([&](std::size_t begin, const Side&) { ++starts[begin + 1]; });
    for (std::size_t i = 1; i < starts.size(); ++i)
        starts[i] += starts[i - 1];
    std::vector<Side> sides(starts.back());
    std::vector<std::uint32_t> next(starts.begin(), starts.end() - 1);
    for_each_side([&](std::size_t begin, const Side& side) { sides[next[begin]++] = side; });

    edges.of_triangle.reserve(scene.triangles.size());
    edges.of_triangle.resize(scene.triangles.size());
    for (std::size_t begin = 0; begin + 1 < starts.size(); ++begin) {
        const auto first = sides.begin() + starts[begin];
        const auto last = sides.begin() + starts[begin + 1];
        std::sort(first, last, [](const Side& a, const Side& b) {
            return a.end != b.end ? a.end < b.end : a.triangle < b.triangle;
        });
        for (auto side = first; side != last; ++side) {
            if (side == first || side->end != (side - 1)->end)
                edges.edges.push_back(
                    {static_cast<std::uint32_t>(first_vertex + begin), side->end});
            edges.of_triangle[side->triangle][side->number] =
                static_cast<std::uint32_t>(edges.edges.size() - 1);
        }
    }
}

ScreenEdges screen_edges(const ScreenScene& scene) {
    ScreenEdges edges;
    add_edges(scene, 0, 0, edges);
    return edges;
}

std::vector<EdgeNeighbours> edge_neighbours(
    const ScreenScene& scene,
    const ScreenEdges& edges,
    std::size_t first_triangle,
    std::size_t first_edge) {
    constexpr std::uint32_t several = no_triangle - 1;
    std::vector<EdgeNeighbours> result(edges.edges.size() - first_edge);
    for (auto i = static_cast<std::uint32_t>(first_triangle); i < scene.triangles.size(); ++i)
        for (std::size_t side = 0; side < 3; ++side) {
            const std::uint32_t edge = edges.of_triangle[i][side];
            // Its corners go round to the left.
            const bool is_left = scene.triangles[i].vertices[side] == edges.edges[edge].begin;
            EdgeNeighbours& beside = result[edge - first_edge];
            std::uint32_t& place = is_left ? beside.left : beside.right;
            place = place == no_triangle ? i : several;
        }
    for (EdgeNeighbours& of_edge : result)
        for (std::uint32_t* place : {&of_edge.left, &of_edge.right})
            if (*place == several)
                *place = no_triangle;
    return result;
}

EdgeTriangles edge_triangles(const ScreenScene& scene, const ScreenEdges& edges) {
    EdgeTriangles result;
    result.starts.resize(edges.edges.size() + 1);
    const auto for_each_side = [&](const auto& visit) {
        for (std::uint32_t i = 0; i < edges.of_triangle.size(); ++i)
            for (const std::uint32_t edge : edges.of_triangle[i])
                if (!scene.triangles[i].is_shadow())
                    visit(edge, i);
    };
    for_each_side([&](std::uint32_t edge, std::uint32_t) { ++result.starts[edge + 1]; });
    for (std::size_t i = 1; i < result.starts.size(); ++i)
        result.starts[i] += result.starts[i - 1];
    result.triangles.resize(result.starts.back());
    std::vector<std::uint32_t> next(result.starts.begin(), result.starts.end() - 1);
    for_each_side([&](std::uint32_t edge, std::uint32_t i) { result.triangles[next[edge]++] = i; });
    return result;
}

} // namespace vera
