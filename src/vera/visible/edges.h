// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/screen_scene.h"

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// The sides of triangles, each once for all triangles that have it between the same vertices.
struct ScreenEdges {
    struct Edge {
        std::uint32_t begin = 0; ///< vertices, the smaller number first
        std::uint32_t end = 0;

        friend auto operator<=>(const Edge&, const Edge&) = default;
    };

    std::vector<Edge> edges; ///< in ascending order
    /// Of each triangle, the edge from its corner i to the one that follows.
    std::vector<std::array<std::uint32_t, 3>> of_triangle;
};

ScreenEdges screen_edges(const ScreenScene& scene);

/// Adds those of the triangles from that one on, whose vertices are from that one on and belong to
/// no other triangle.
void add_edges(
    const ScreenScene& scene,
    std::size_t first_triangle,
    std::size_t first_vertex,
    ScreenEdges& edges);

/// The triangles beside an edge, which have it for a side, or no_triangle: where there are none, or
/// several on one side.
struct EdgeNeighbours {
    std::uint32_t left = no_triangle; ///< of the way from its begin to its end
    std::uint32_t right = no_triangle;

    /// One on each side.
    bool are_two() const { return left != no_triangle && right != no_triangle; }
};

/// Of each edge, or of those from that one on, which only triangles from that one on have.
std::vector<EdgeNeighbours> edge_neighbours(
    const ScreenScene& scene,
    const ScreenEdges& edges,
    std::size_t first_triangle = 0,
    std::size_t first_edge = 0);

/// The surfaces that have each edge.
struct EdgeTriangles {
    std::vector<std::uint32_t> starts;    ///< edge i has triangles[starts[i]] to [starts[i + 1]]
    std::vector<std::uint32_t> triangles; ///< in ascending order within an edge

    std::span<const std::uint32_t> of(std::uint32_t edge) const {
        return std::span(triangles).subspan(starts[edge], starts[edge + 1] - starts[edge]);
    }
};

EdgeTriangles edge_triangles(const ScreenScene& scene, const ScreenEdges& edges);

} // namespace vera
