// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/edges.h"

#include <algorithm>
#include <cstddef>

namespace vera {

ScreenEdges screen_edges(const ScreenScene& scene) {
    struct Side {
        std::uint32_t end;
        std::uint32_t triangle;
        std::uint32_t number; ///< of the side in its triangle
    };

    // In groups by their first vertex, which are short.
    std::vector<std::uint32_t> starts(scene.vertices.size() + 1);
    const auto for_each_side = [&](const auto& visit) {
        for (std::uint32_t i = 0; i < scene.triangles.size(); ++i)
            for (std::uint32_t side = 0; side < 3; ++side) {
                const auto& vertices = scene.triangles[i].vertices;
                const std::uint32_t from = vertices[side];
                const std::uint32_t to = vertices[(side + 1) % 3];
                visit(std::min(from, to), Side{std::max(from, to), i, side});
            }
    };
    for_each_side([&](std::uint32_t begin, const Side&) { ++starts[begin + 1]; });
    for (std::size_t i = 1; i < starts.size(); ++i)
        starts[i] += starts[i - 1];
    std::vector<Side> sides(starts.back());
    std::vector<std::uint32_t> next(starts.begin(), starts.end() - 1);
    for_each_side([&](std::uint32_t begin, const Side& side) { sides[next[begin]++] = side; });

    ScreenEdges result;
    result.of_triangle.resize(scene.triangles.size());
    for (std::uint32_t begin = 0; begin + 1 < starts.size(); ++begin) {
        const auto first = sides.begin() + starts[begin];
        const auto last = sides.begin() + starts[begin + 1];
        std::sort(first, last, [](const Side& a, const Side& b) {
            return a.end != b.end ? a.end < b.end : a.triangle < b.triangle;
        });
        for (auto side = first; side != last; ++side) {
            if (side == first || side->end != (side - 1)->end)
                result.edges.push_back({begin, side->end});
            result.of_triangle[side->triangle][side->number] =
                static_cast<std::uint32_t>(result.edges.size() - 1);
        }
    }
    return result;
}

std::vector<EdgeNeighbours> edge_neighbours(const ScreenScene& scene, const ScreenEdges& edges) {
    constexpr std::uint32_t several = no_triangle - 1;
    std::vector<EdgeNeighbours> result(edges.edges.size());
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i)
        for (std::size_t side = 0; side < 3; ++side) {
            const std::uint32_t edge = edges.of_triangle[i][side];
            // Its corners go round to the left.
            const bool is_left = scene.triangles[i].vertices[side] == edges.edges[edge].begin;
            std::uint32_t& place = is_left ? result[edge].left : result[edge].right;
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
