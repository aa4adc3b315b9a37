// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/plane_sweep.h"

#include "vera/base/available_memory.h"
#include "vera/base/long_loop.h"
#include "vera/base/random.h"
#include "vera/visible/connection_graph.h"
#include "vera/visible/edges.h"
#include "vera/visible/inclusion_set.h"
#include "vera/visible/seen_beside.h"
#include "vera/visible/sweep_segments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace vera {

namespace {

/// A part of an edge between neighbouring vertices, with different sources beside it.
struct VisiblePart {
    std::uint32_t edge = 0;
    std::uint32_t from = 0; ///< vertices, in the direction of the edge
    std::uint32_t to = 0;
    std::uint32_t left = no_triangle;
    std::uint32_t right = no_triangle;
};

/// What all parts are found by.
struct SweptScene {
    const ScreenScene& scene;
    std::vector<NearnessSlope> slopes;
    ScreenEdges edges;
    SweepSegments segments;
};

SweptScene swept_scene(const ScreenScene& scene, const CancelFlag* cancel) {
    SweptScene swept = {scene, slopes_of(scene), {}, {}};
    stop_if_raised(cancel);
    swept.edges = screen_edges(scene);
    stop_if_raised(cancel);
    swept.segments = sweep_segments(scene, swept.edges, cancel);
    return swept;
}

/// Tells what is seen beside each edge of the graph.
class PartFinder {
public:
    PartFinder(const SweptScene& swept, const ConnectionGraph& graph, PlaneSweepCounts& counts)
        : swept_(swept)
        , graph_(graph)
        , counts_(counts)
        , seen_(swept.scene, swept.slopes) {}

    /// `below` are the triangles below the edge, about from the front to the back.
    void look_at(
        std::uint32_t vertex,
        const ConnectionGraph::Edge& edge,
        std::span<const std::uint32_t> below);

    /// How often look_at() put two triangles in order, but for those that one hides at first sight.
    std::uint64_t comparisons() const { return seen_.comparisons(); }

    std::vector<VisiblePart> parts;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> penetrating;

private:
    using Borders = std::span<const SweepSegments::Border>;

    /// A triangle beside the present edge, which is a part of this edge of it, or of none.
    struct Beside {
        std::uint32_t triangle = no_triangle;
        std::uint32_t edge = no_triangle;
    };

    bool is_hidden(Borders borders, std::span<const std::uint32_t> below);
    void gather(Borders borders, std::span<const std::uint32_t> below);
    void add_part(std::uint32_t vertex, std::uint32_t end, const Beside& left, const Beside& right);

    std::uint32_t source_of(std::uint32_t triangle) const {
        return triangle == no_triangle ? no_source : swept_.scene.triangles[triangle].source;
    }

    const SweptScene& swept_;
    const ConnectionGraph& graph_;
    PlaneSweepCounts& counts_;
    SeenBeside seen_;
    std::vector<Beside> beside_; ///< as they were added to seen_
};

/// Whether one of the first triangles lies before all that end at the edge: the same is then seen
/// on both sides. Says no where it is not sure.
bool PartFinder::is_hidden(Borders borders, std::span<const std::uint32_t> below) {
    constexpr std::size_t most = 8;
    const auto first = below.first(std::min(below.size(), most));
    return std::any_of(first.begin(), first.end(), [&](std::uint32_t triangle) {
        return std::all_of(borders.begin(), borders.end(), [&](const auto& border) {
            ++counts_.depth_orders;
            return seen_.hides(triangle, border.triangle);
        });
    });
}

/// Gathers the triangles beside an edge.
void PartFinder::gather(Borders borders, std::span<const std::uint32_t> below) {
    beside_.clear();
    for (const SweepSegments::Border& border : borders) {
        seen_.add(border.triangle, border.is_above ? left_side : right_side);
        beside_.push_back({border.triangle, border.edge});
    }
    for (const std::uint32_t triangle : below) {
        const bool ends_here = std::any_of(borders.begin(), borders.end(), [&](const auto& border) {
            return border.triangle == triangle;
        });
        if (ends_here)
            continue;
        seen_.add(triangle, left_side | right_side);
        beside_.push_back({triangle});
    }
}

void PartFinder::look_at(
    std::uint32_t vertex, const ConnectionGraph::Edge& edge, std::span<const std::uint32_t> below) {
    const SweepPoint& from = graph_.vertices[vertex].point;
    const SweepPoint& to = graph_.vertices[edge.end].point;
    const auto& [begin, end] = swept_.segments.segments[edge.segment];
    const Borders borders = swept_.segments.borders_of(edge.segment);
    seen_.follow(begin, end);
    seen_.start({from.x, from.y}, {to.x, to.y});
    if (is_hidden(borders, below))
        return;
    ++counts_.looked_at;
    gather(borders, below);
    counts_.candidates += beside_.size();
    const SeenBeside::Seen seen = seen_.find(penetrating);
    add_part(
        vertex,
        edge.end,
        seen.left == SeenBeside::nothing ? Beside{} : beside_[seen.left],
        seen.right == SeenBeside::nothing ? Beside{} : beside_[seen.right]);
}

void PartFinder::add_part(
    std::uint32_t vertex, std::uint32_t end, const Beside& left, const Beside& right) {
    if (source_of(left.triangle) == source_of(right.triangle))
        return;
    // Of several edges in one place that what is seen beside it has, the first speaks for all.
    const std::uint32_t edge = std::min(left.edge, right.edge);
    if (edge == no_triangle)
        return;
    const auto& [edge_begin, edge_end] = swept_.edges.edges[edge];
    const bool is_rightward =
        swept_.scene.vertices[edge_begin].point < swept_.scene.vertices[edge_end].point;
    if (is_rightward)
        parts.push_back({edge, vertex, end, left.triangle, right.triangle});
    else
        parts.push_back({edge, end, vertex, right.triangle, left.triangle});
}

/// Joins parts that follow each other on an edge to pieces, where nothing else that is seen ends.
VisiblePieces
joined(const SweptScene& swept, const ConnectionGraph& graph, std::vector<VisiblePart>& parts) {
    std::vector<std::uint8_t> meeting(graph.vertex_count());
    for (const VisiblePart& part : parts)
        for (const std::uint32_t vertex : {part.from, part.to})
            meeting[vertex] = static_cast<std::uint8_t>(std::min(meeting[vertex] + 1, 3));
    // Vertices are numbered from the left to the right.
    std::sort(parts.begin(), parts.end(), [](const VisiblePart& a, const VisiblePart& b) {
        if (a.edge != b.edge)
            return a.edge < b.edge;
        return a.from < a.to ? a.from < b.from : a.from > b.from;
    });
    PlaneSweepCounts uncounted;
    const SweepPredicates predicates(swept.segments.segments, uncounted);
    VisiblePieces result;
    constexpr std::uint32_t unnumbered = ~std::uint32_t{0};
    std::vector<std::uint32_t> numbers(graph.vertex_count(), unnumbered);
    const auto point = [&](std::uint32_t vertex) {
        if (numbers[vertex] == unnumbered) {
            numbers[vertex] = static_cast<std::uint32_t>(result.points.size());
            result.points.push_back(predicates.exact(graph.vertices[vertex].point));
        }
        return numbers[vertex];
    };
    const auto goes_on = [&](const VisiblePart& before, const VisiblePart& after) {
        // Where edges cross, what is seen beside both changes; at a corner it need not.
        return after.edge == before.edge && before.to == after.from
            && (meeting[before.to] == 2 || graph.vertices[before.to].point.is_crossing())
            && after.left == before.left && after.right == before.right;
    };
    std::size_t count = parts.empty() ? 0 : 1;
    for (std::size_t i = 1; i < parts.size(); ++i)
        count += goes_on(parts[i - 1], parts[i]) ? 0 : 1;
    result.pieces.reserve(count);
    for (std::size_t first = 0, next = 0; first < parts.size(); first = next) {
        for (next = first + 1; next < parts.size() && goes_on(parts[next - 1], parts[next]);)
            ++next;
        const VisiblePart& part = parts[first];
        const std::uint32_t from = point(part.from);
        const std::uint32_t to = point(parts[next - 1].to);
        result.pieces.push_back({from, to, swept.edges.edges[part.edge], part.left, part.right});
    }
    return result;
}

/// How many pairs of segments cross: all are asked, or as many as suffice, at random.
double
crossings_of(std::span<const SweepSegments::Segment> segments, const CancelFlag* cancel = nullptr) {
    PlaneSweepCounts uncounted;
    const SweepPredicates predicates(segments, uncounted);
    const auto do_cross = [&](std::uint64_t i, std::uint64_t j) {
        const auto a = static_cast<std::uint32_t>(i);
        const auto b = static_cast<std::uint32_t>(j);
        return predicates.crossing(a, b) || predicates.crossing(b, a);
    };
    constexpr std::uint64_t samples = std::uint64_t{1} << 20U;
    const std::uint64_t count = segments.size();
    const std::uint64_t pairs = count * (count - std::min<std::uint64_t>(count, 1)) / 2;
    std::uint64_t found = 0;
    if (pairs <= samples) {
        for (std::uint64_t i = 0; i < count; ++i)
            for (std::uint64_t j = 0; j < i; ++j)
                found += do_cross(i, j) ? 1 : 0;
        return static_cast<double>(found);
    }
    const LongLoop loop(samples, {}, cancel);
    for (std::uint64_t i = 0; i < samples; ++i) {
        loop.turn(i);
        const std::uint64_t a = random(1988, i, 0) % count;
        const std::uint64_t b = random(1988, i, 1) % count;
        found += a != b && do_cross(a, b) ? 1 : 0;
    }
    return static_cast<double>(found) / samples * static_cast<double>(pairs);
}

SweepForecast forecast_of(const SweepSegments& segments, const CancelFlag* cancel = nullptr) {
    // A vertex of the graph with two edges and three gaps, and crossings that wait: 88. Where most
    // is seen, pieces take half as much again. A segment has its ends, its rung and what is
    // remembered of it.
    constexpr double per_crossing = 120;
    constexpr double per_segment = 350;
    SweepForecast forecast;
    forecast.crossings = crossings_of(segments.segments, cancel);
    forecast.bytes = per_crossing * forecast.crossings
        + per_segment * static_cast<double>(segments.segments.size())
        + sizeof(SweepSegments::Border) * static_cast<double>(segments.borders.size());
    return forecast;
}

SweepForecast checked_forecast(
    const SweepSegments& segments, std::optional<std::uint64_t> most, const CancelFlag* cancel) {
    const SweepForecast forecast = forecast_of(segments, cancel);
    const std::string what = "a sweep would meet about "
        + std::to_string(static_cast<std::uint64_t>(forecast.crossings))
        + " crossings of edges, which";
    const std::string remedy = "take --engine cells, which keeps no crossings";
    if (most)
        require_memory(forecast.bytes, most, what, remedy);
    else
        require_memory(forecast.bytes, what, remedy);
    return forecast;
}

} // namespace

SweepForecast sweep_forecast(const ScreenScene& scene) {
    return forecast_of(sweep_segments(scene, screen_edges(scene)));
}

VisiblePieces plane_sweep(
    const ScreenScene& scene,
    const PlaneSweepSettings& settings,
    const Progress& progress,
    const CancelFlag* cancel) {
    const SweptScene swept = swept_scene(scene, cancel);
    stop_if_raised(cancel);
    const SweepForecast forecast = checked_forecast(swept.segments, settings.most_bytes, cancel);
    PlaneSweepCounts counts;
    constexpr double part_of_graph = 0.5; // of the time
    ConnectionGraph graph = connection_graph(
        swept.segments.segments,
        static_cast<std::size_t>(forecast.crossings),
        counts,
        [&](double done) {
            if (progress)
                progress(part_of_graph * done);
        },
        cancel);

    PartFinder finder(swept, graph, counts);
    InclusionSet set(scene, swept.slopes, counts);
    std::size_t edges = 0;
    traverse(
        graph,
        swept.segments,
        set,
        cancel,
        [&](std::uint32_t vertex, const ConnectionGraph::Edge& edge, const InclusionSet& below) {
            finder.look_at(vertex, edge, below.triangles());
            if (++edges % 1024 == 0 && progress)
                progress(
                    part_of_graph
                    + (1 - part_of_graph) * static_cast<double>(edges)
                        / static_cast<double>(graph.edges.size()));
        });
    counts.visible_edges = finder.parts.size();
    counts.depth_orders += finder.comparisons();
    if (settings.counts != nullptr)
        *settings.counts = counts;

    // Pieces need as much room as what is no longer asked for.
    stop_if_raised(cancel);
    std::vector<ConnectionGraph::Edge>().swap(graph.edges);
    std::vector<std::uint32_t>().swap(graph.gaps);
    VisiblePieces result = joined(swept, graph, finder.parts);
    result.penetrating = std::move(finder.penetrating);
    std::sort(result.penetrating.begin(), result.penetrating.end());
    result.penetrating.erase(
        std::unique(result.penetrating.begin(), result.penetrating.end()),
        result.penetrating.end());
    return result;
}

} // namespace vera
