// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/visible/sweep_counts.h"
#include "vera/visible/sweep_points.h"
#include "vera/visible/sweep_segments.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// The plane graph that segments make together (appendix of the VERA paper, pass 1): its vertices
/// are their ends and crossings, its edges the parts of segments between these. From every vertex a
/// way leads back to vertex 0: the drain. That is the steepest edge that comes from the left or,
/// where none does, a straight line to the last vertex before on the border of the gap between
/// segments that this one lies in, which crosses nothing: the gap is convex so far.
struct ConnectionGraph {
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    struct Vertex {
        SweepPoint point;
        std::uint32_t first_edge = 0;
        std::uint32_t drain = none; ///< in edges; none where that is no part of a segment
    };

    /// An edge belongs to the vertex at its left end.
    struct Edge {
        std::uint32_t segment = 0;
        std::uint32_t end = none; ///< the vertex to the right
    };

    std::vector<Vertex> vertices; ///< from left to right, and one behind the last
    std::vector<Edge> edges;      ///< of each vertex in turn, from the lowest to the highest
    /// Of each vertex in turn: for the gap below its edges, those between them, and that above, the
    /// vertex which drains there by a line of its own, or none.
    std::vector<std::uint32_t> gaps;

    std::size_t vertex_count() const { return vertices.empty() ? 0 : vertices.size() - 1; }

    std::span<const Edge> edges_of(std::uint32_t vertex) const {
        return std::span(edges).subspan(
            vertices[vertex].first_edge,
            vertices[vertex + 1].first_edge - vertices[vertex].first_edge);
    }

    /// One more than it has edges.
    std::span<const std::uint32_t> gaps_of(std::uint32_t vertex) const {
        return std::span(gaps).subspan(
            vertices[vertex].first_edge + std::size_t{vertex}, edges_of(vertex).size() + 1);
    }
};

/// By a sweep from left to right (Bentley and Ottmann, Algorithms for reporting and counting
/// geometric intersections, 1979): O((n + k) log n) steps for n segments and k crossings, whatever
/// falls together in one point. `expected` crossings are made room for. Where there are more than
/// 2^32 - 2 vertices or edges, throws std::length_error.
ConnectionGraph connection_graph(
    std::span<const SweepSegments::Segment> segments,
    std::size_t expected,
    PlaneSweepCounts& counts,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
