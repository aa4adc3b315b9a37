// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/connection_graph.h"
#include "vera/visible/sweep_counts.h"
#include "vera/visible/sweep_segments.h"
#include "vera/visible/triangle_order.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// The triangles that cover a place of the picture, about from the front to the back: exactly so
/// where their order is transitive, which rounding, and what passes through other things, may
/// prevent.
class InclusionSet {
public:
    /// All must outlive this.
    InclusionSet(
        const ScreenScene& scene, std::span<const NearnessSlope> slopes, PlaneSweepCounts& counts)
        : scene_(scene)
        , slopes_(slopes)
        , counts_(counts) {}

    std::span<const std::uint32_t> triangles() const { return triangles_; }

    /// What the set is above a segment that has these borders, when it is now that below it, with
    /// the places on the segment by which what comes in is put in order.
    void go_up(
        std::span<const SweepSegments::Border> borders, const std::array<NearnessPlace, 2>& places);

    /// How many changes were made.
    std::size_t changes() const { return changes_.size(); }

    /// Takes changes back, the last first, until so many are left.
    void take_back(std::size_t changes);

private:
    struct Change {
        std::uint32_t position;
        std::uint32_t triangle;
        bool came_in;
    };

    bool
    is_before(std::uint32_t a, std::uint32_t b, const std::array<NearnessPlace, 2>& places) const;

    const ScreenScene& scene_;
    std::span<const NearnessSlope> slopes_;
    PlaneSweepCounts& counts_;
    std::vector<std::uint32_t> triangles_;
    std::vector<Change> changes_;
};

/// Goes through the connection graph along its drains, each edge of a segment once upward and once
/// back (appendix of the VERA paper, pass 2), and calls visit(vertex, edge, set) for each with the
/// set below it. Set needs what InclusionSet has to go up and to take back.
template <typename Set, typename Visit>
void traverse(
    const ConnectionGraph& graph,
    const SweepSegments& segments,
    Set& set,
    const CancelFlag* cancel,
    const Visit& visit) {
    struct Stop {
        std::uint32_t vertex;
        std::uint32_t step;  ///< even: the gap above edge step / 2 - 1; odd: edge step / 2
        std::size_t changes; ///< of the set, when the vertex was reached
    };

    const auto place = [&](std::uint32_t vertex) {
        const SweepPoint& point = graph.vertices[vertex].point;
        return NearnessPlace{point.x, point.y};
    };
    std::vector<Stop> way;
    if (graph.vertex_count() > 0)
        way.push_back({0, 0, 0});
    for (std::size_t turn = 0; !way.empty(); ++turn) {
        if (cancel != nullptr && turn % 1024 == 0)
            cancel->throw_if_raised();
        const auto [vertex, step, changes] = way.back();
        const auto edges = graph.edges_of(vertex);
        if (step > 2 * edges.size()) {
            set.take_back(changes);
            way.pop_back();
            continue;
        }
        ++way.back().step;
        if (step % 2 != 0) {
            const ConnectionGraph::Edge& edge = edges[step / 2];
            visit(vertex, edge, set);
            // The drain is the lowest edge from the left, so below it and all round to the right of
            // its end it is as below here.
            if (graph.vertices[edge.end].drain == graph.vertices[vertex].first_edge + step / 2)
                way.push_back({edge.end, 0, set.changes()});
            continue;
        }
        if (step > 0) {
            const ConnectionGraph::Edge& edge = edges[step / 2 - 1];
            set.go_up(segments.borders_of(edge.segment), {place(vertex), place(edge.end)});
        }
        const std::uint32_t drained = graph.gaps_of(vertex)[step / 2];
        if (drained != ConnectionGraph::none)
            way.push_back({drained, 0, set.changes()});
    }
}

} // namespace vera
