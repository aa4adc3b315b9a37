// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/sweep_segments.h"

#include "vera/base/long_loop.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace vera {

namespace {

/// An edge from its lower end to the other, and the line in which it lies: a x + b y = c, in lowest
/// terms.
struct EdgeOnLine {
    std::int64_t a = 0;
    std::int64_t b = 0;
    std::int64_t c = 0;
    ScreenPoint begin;
    ScreenPoint end;
    std::uint32_t edge = 0;

    auto line() const { return std::tie(a, b, c); }

    auto key() const { return std::tie(a, b, c, begin, end, edge); }
};

static_assert(2 * screen_bits + 2 < 63, "c must not overflow");

EdgeOnLine on_line(const ScreenScene& scene, const ScreenEdges& edges, std::uint32_t edge) {
    const ScreenPoint one = scene.vertices[edges.edges[edge].begin].point;
    const ScreenPoint other = scene.vertices[edges.edges[edge].end].point;
    const ScreenPoint begin = std::min(one, other);
    const ScreenPoint end = std::max(one, other);
    ScreenStep direction = step(begin, end);
    const std::int64_t common = std::gcd(direction.x, direction.y);
    direction = {direction.x / common, direction.y / common};
    return {
        direction.y, -direction.x, direction.y * begin.x - direction.x * begin.y, begin, end, edge};
}

/// The triangles at each edge.
struct EdgeBorders {
    std::vector<std::size_t> starts;
    std::vector<SweepSegments::Border> borders;

    explicit EdgeBorders(const ScreenScene& scene, const ScreenEdges& edges)
        : starts(edges.edges.size() + 1)
        , borders(3 * scene.triangles.size()) {
        for (const auto& sides : edges.of_triangle)
            for (const std::uint32_t edge : sides)
                ++starts[edge + 1];
        std::partial_sum(starts.begin(), starts.end(), starts.begin());
        std::vector<std::size_t> next(starts.begin(), starts.end() - 1);
        for (std::uint32_t i = 0; i < edges.of_triangle.size(); ++i)
            for (std::size_t side = 0; side < 3; ++side) {
                // Corners go round to the left.
                const auto corners = corners_of(scene, scene.triangles[i]);
                const bool is_above = corners[side].point < corners[(side + 1) % 3].point;
                const std::uint32_t edge = edges.of_triangle[i][side];
                borders[next[edge]++] = {i, edge, is_above};
            }
    }

    void append(std::uint32_t edge, std::vector<SweepSegments::Border>& to) const {
        for (std::size_t i = starts[edge]; i < starts[edge + 1]; ++i)
            to.push_back(borders[i]);
    }
};

/// Adds the parts of edges of one line, which are in order of their beginnings.
void add_parts(
    std::span<const EdgeOnLine> edges, const EdgeBorders& borders, SweepSegments& result) {
    std::vector<ScreenPoint> ends;
    for (const EdgeOnLine& edge : edges) {
        ends.push_back(edge.begin);
        ends.push_back(edge.end);
    }
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    std::vector<const EdgeOnLine*> active;
    std::size_t next = 0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        std::erase_if(active, [&](const EdgeOnLine* edge) { return edge->end == ends[i]; });
        for (; next < edges.size() && edges[next].begin == ends[i]; ++next)
            active.push_back(&edges[next]);
        if (active.empty())
            continue;
        result.segments.push_back({ends[i], ends[i + 1]});
        for (const EdgeOnLine* edge : active)
            borders.append(edge->edge, result.borders);
        result.starts.push_back(result.borders.size());
    }
}

} // namespace

SweepSegments
sweep_segments(const ScreenScene& scene, const ScreenEdges& edges, const CancelFlag* cancel) {
    std::vector<EdgeOnLine> lines(edges.edges.size());
    const LongLoop loop(lines.size(), {}, cancel);
    for (std::uint32_t i = 0; i < lines.size(); ++i) {
        loop.turn(i);
        lines[i] = on_line(scene, edges, i);
    }
    std::sort(lines.begin(), lines.end(), [](const EdgeOnLine& a, const EdgeOnLine& b) {
        return a.key() < b.key();
    });
    stop_if_raised(cancel);
    const EdgeBorders borders(scene, edges);
    SweepSegments result;
    result.segments.reserve(lines.size());
    result.borders.reserve(borders.borders.size());
    result.starts.reserve(lines.size() + 1);
    result.starts.push_back(0);
    for (auto first = lines.begin(); first != lines.end();) {
        stop_if_raised(cancel);
        const auto last = std::find_if(first, lines.end(), [&](const EdgeOnLine& edge) {
            return edge.line() != first->line();
        });
        add_parts({first, last}, borders, result);
        first = last;
    }
    return result;
}

} // namespace vera
