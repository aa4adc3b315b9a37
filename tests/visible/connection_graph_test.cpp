// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/connection_graph.h"
#include "vera/visible/edges.h"
#include "vera/visible/inclusion_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using Segments = std::vector<SweepSegments::Segment>;

/// The closed ways round the faces of the graph, drains included, each face on the left.
std::size_t ways_round_faces(const ConnectionGraph& graph, const Segments& segments) {
    // An edge is number 2 i rightward and 2 i + 1 leftward; drains come after the others.
    struct Coming {
        std::size_t edge;
        std::uint32_t segment;
    };

    const auto count = static_cast<std::uint32_t>(graph.vertex_count());
    std::vector<std::vector<std::size_t>> leaving(count); // to the right, from the lowest
    std::vector<std::vector<Coming>> coming(count);
    std::size_t drains = graph.edges.size();
    for (std::uint32_t vertex = 0; vertex < count; ++vertex) {
        const auto edges = graph.edges_of(vertex);
        const auto gaps = graph.gaps_of(vertex);
        for (std::size_t i = 0; i <= edges.size(); ++i) {
            if (gaps[i] != ConnectionGraph::none) {
                leaving[vertex].push_back(drains);
                coming[gaps[i]].push_back({drains++, no_segment});
            }
            if (i == edges.size())
                break;
            const std::size_t edge = graph.vertices[vertex].first_edge + i;
            leaving[vertex].push_back(edge);
            coming[edges[i].end].push_back({edge, edges[i].segment});
        }
    }
    // Of each directed edge the one that is the next to the right behind its end.
    std::vector<std::size_t> next(2 * drains);
    for (std::uint32_t vertex = 0; vertex < count; ++vertex) {
        // Round to the left: rightward edges from the lowest, then leftward ones from the highest.
        std::sort(coming[vertex].begin(), coming[vertex].end(), [&](const auto& a, const auto& b) {
            return cross(
                       step(segments[a.segment].begin, segments[a.segment].end),
                       step(segments[b.segment].begin, segments[b.segment].end))
                > 0;
        });
        std::vector<std::size_t> round;
        for (const std::size_t edge : leaving[vertex])
            round.push_back(2 * edge);
        for (const Coming& edge : coming[vertex])
            round.push_back(2 * edge.edge + 1);
        for (std::size_t i = 0; i < round.size(); ++i)
            next[round[i] ^ 1U] = round[i == 0 ? round.size() - 1 : i - 1];
    }
    std::vector<bool> done(next.size());
    std::size_t ways = 0;
    for (std::size_t first = 0; first < next.size(); ++first) {
        ways += done[first] ? 0 : 1;
        for (std::size_t edge = first; !done[edge]; edge = next[edge])
            done[edge] = true;
    }
    return ways;
}

ConnectionGraph graph_of(const Segments& segments, PlaneSweepCounts& counts) {
    return connection_graph(segments, 0, counts);
}

/// V - E + F = 2, which is true of a plane graph only if it is connected; and every vertex but the
/// first has a drain.
void expect_connected(
    const ConnectionGraph& graph, const Segments& segments, const PlaneSweepCounts& counts) {
    const std::size_t edges = graph.edges.size() + counts.drains;
    EXPECT_EQ(graph.vertex_count() + ways_round_faces(graph, segments), edges + 2);
    EXPECT_EQ(counts.corners + counts.crossings, graph.vertex_count());
    std::size_t natural = 0;
    for (std::size_t i = 0; i < graph.vertex_count(); ++i)
        natural += graph.vertices[i].drain != ConnectionGraph::none ? 1 : 0;
    EXPECT_EQ(natural + counts.drains + 1, graph.vertex_count());
}

TEST(ConnectionGraph, OfALatticeWithDiagonalsHasItsCrossingsOnce) {
    constexpr std::int32_t m = 12;
    constexpr std::int32_t wide = screen_size / 16;
    Segments segments;
    const auto add = [&](std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1) {
        const ScreenPoint a = {x0 * wide, y0 * wide};
        const ScreenPoint b = {x1 * wide, y1 * wide};
        segments.push_back({std::min(a, b), std::max(a, b)});
    };
    for (std::int32_t i = 0; i <= m; ++i) {
        add(0, i, m, i);
        add(i, 0, i, m);
    }
    for (std::int32_t i = 0; i < m; ++i) {
        add(i, 0, m, m - i);
        add(0, i + 1, i + 1, 0);
    }
    for (std::int32_t i = 1; i < m; ++i) {
        add(0, i, m - i, m);
        add(i, m, m, i);
    }
    PlaneSweepCounts counts;
    const ConnectionGraph graph = graph_of(segments, counts);
    EXPECT_EQ(graph.vertex_count(), std::size_t{(m + 1) * (m + 1) + m * m});
    EXPECT_EQ(ways_round_faces(graph, segments), std::size_t{4 * m * m + 1});
    expect_connected(graph, segments, counts);
}

TEST(ConnectionGraph, OfTwoBundlesHasAQuarterOfTheSquareOfCrossings) {
    constexpr std::int32_t half = 60;
    Segments segments;
    for (std::int32_t i = 0; i < half; ++i) {
        segments.push_back({{0, 3 * i}, {screen_size, screen_size / 2 + 5 * i}});
        segments.push_back({{0, screen_size - 3 * i}, {screen_size, 1000 - 7 * i}});
    }
    PlaneSweepCounts counts;
    const ConnectionGraph graph = graph_of(segments, counts);
    EXPECT_EQ(counts.crossings, std::uint64_t{half * half});
    EXPECT_EQ(counts.queued, counts.crossings);
    expect_connected(graph, segments, counts);
    // Each crossing meets four edges.
    EXPECT_EQ(graph.edges.size(), segments.size() + 2 * counts.crossings);
}

TEST(ConnectionGraph, IsConnectedAndPlaneWhateverFallsTogether) {
    for (std::uint64_t seed = 0; seed < 300 && !HasFailure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const ScreenScene scene = seed % 2 == 0
            ? testing::layers(seed, 1 + seed % 40, std::int32_t{1} << (1 + seed % 4))
            : testing::slivers(seed, 1 + seed % 40);
        const SweepSegments segments = sweep_segments(scene, screen_edges(scene));
        PlaneSweepCounts counts;
        const ConnectionGraph graph = graph_of(segments.segments, counts);
        expect_connected(graph, segments.segments, counts);
    }
}

TEST(ConnectionGraph, HasEveryCrossingOfEveryPair) {
    for (std::uint64_t seed = 0; seed < 60 && !HasFailure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const ScreenScene scene =
            testing::layers(seed, 1 + seed % 20, std::int32_t{1} << (1 + seed % 6));
        const Segments segments = sweep_segments(scene, screen_edges(scene)).segments;

        struct Less {
            bool operator()(const RationalPoint& a, const RationalPoint& b) const {
                return order(a, b) < 0;
            }
        };

        std::map<RationalPoint, int, Less> expected;
        for (const auto& [begin, end] : segments) {
            ++expected[{begin}];
            ++expected[{end}];
        }
        for (const auto& a : segments)
            for (const auto& b : segments) {
                if (cross(step(a.begin, a.end), step(b.begin, b.end)) == 0)
                    continue;
                const SegmentPlace on_a = crossing_place(a.begin, a.end, b.begin, b.end);
                const SegmentPlace on_b = crossing_place(b.begin, b.end, a.begin, a.end);
                const auto within = [](SegmentPlace place) {
                    return place.numerator >= 0 && place.numerator <= place.denominator;
                };
                if (within(on_a) && within(on_b))
                    ++expected[point_at(a.begin, a.end, on_a)];
            }
        PlaneSweepCounts counts;
        const ConnectionGraph graph = graph_of(segments, counts);
        const SweepPredicates predicates(segments, counts);
        ASSERT_EQ(graph.vertex_count(), expected.size());
        std::size_t i = 0;
        for (const auto& [point, meeting] : expected)
            EXPECT_EQ(predicates.exact(graph.vertices[i++].point), point);
    }
}

/// Segments close to each other, so that doubles do not suffice, or anywhere.
Segments random_segments(std::mt19937_64& random, std::int32_t range) {
    const std::int32_t from = range > 40 ? 0 : screen_size - 100;
    const auto any = [&] {
        return from + static_cast<std::int32_t>(random() % static_cast<std::uint64_t>(range));
    };
    Segments segments;
    while (segments.size() < 12) {
        const ScreenPoint a = {any(), any()};
        const ScreenPoint b = {any(), any()};
        if (a != b)
            segments.push_back({std::min(a, b), std::max(a, b)});
    }
    return segments;
}

/// Where the segments begin and cross.
std::vector<SweepPoint> points_of(const Segments& segments, const SweepPredicates& predicates) {
    std::vector<SweepPoint> points;
    for (std::uint32_t i = 0; i < segments.size(); ++i) {
        points.push_back(at_end(segments[i].begin));
        for (std::uint32_t j = 0; j < segments.size(); ++j)
            if (const auto crossing = predicates.crossing(i, j))
                points.push_back(*crossing);
    }
    return points;
}

int exact_side(const SweepSegments::Segment& segment, const RationalPoint& point) {
    const ScreenStep whole = step(segment.begin, segment.end);
    const Int128 x =
        Int128{point.whole.x - segment.begin.x} * point.denominator + point.x_numerator;
    const Int128 y =
        Int128{point.whole.y - segment.begin.y} * point.denominator + point.y_numerator;
    return sign(whole.x * y - whole.y * x);
}

TEST(SweepPredicates, AgreeWithFractions) {
    std::mt19937_64 random(1);
    std::size_t same = 0;
    for (const std::int32_t range : {5, 40, screen_size + 1}) {
        for (int round = 0; round < 100; ++round) {
            const Segments segments = random_segments(random, range);
            PlaneSweepCounts counts;
            const SweepPredicates predicates(segments, counts);
            const std::vector<SweepPoint> points = points_of(segments, predicates);
            for (const SweepPoint& a : points) {
                const RationalPoint exact = predicates.exact(a);
                EXPECT_NEAR(exact.x(), a.x, 0x1p-28);
                EXPECT_NEAR(exact.y(), a.y, 0x1p-28);
                for (const SweepPoint& b : points) {
                    const int found = predicates.order(a, b);
                    EXPECT_EQ(found, order(exact, predicates.exact(b)));
                    same += found == 0 ? 1 : 0;
                }
                for (std::uint32_t i = 0; i < segments.size(); ++i)
                    EXPECT_EQ(predicates.side(i, a), exact_side(segments[i], exact));
            }
        }
    }
    EXPECT_GT(same, 1000U);
}

/// Whether the triangle lies right below the place, by asking its sides.
bool covers_below(
    const std::array<ScreenVertex, 3>& corners, NearnessPlace place, ScreenStep along) {
    for (std::size_t i = 0; i < 3; ++i) {
        const ScreenPoint a = corners[i].point;
        const ScreenStep side = step(a, corners[(i + 1) % 3].point);
        const double turn = static_cast<double>(side.x) * (place.y - a.y)
            - static_cast<double>(side.y) * (place.x - a.x);
        const auto length = static_cast<double>(std::abs(side.x) + std::abs(side.y));
        // A side through the place has the edge's direction, and the triangle above or below it.
        if (std::abs(turn) < 1e-3 * length) {
            if (cross(side, along) != 0 || (side.x > 0 || (side.x == 0 && side.y > 0)))
                return false;
        } else if (turn < 0) {
            return false;
        }
    }
    return true;
}

TEST(InclusionSet, HoldsBelowEachEdgeWhatCoversItThereFromTheFrontToTheBack) {
    for (std::uint64_t seed = 0; seed < 200 && !HasFailure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const ScreenScene scene =
            testing::layers(seed, 1 + seed % 40, std::int32_t{1} << (1 + seed % 4));
        std::vector<NearnessSlope> slopes;
        for (const ScreenTriangle& triangle : scene.triangles)
            slopes.push_back(nearness_slope(depth_plane(corners_of(scene, triangle))));
        const SweepSegments segments = sweep_segments(scene, screen_edges(scene));
        PlaneSweepCounts counts;
        const ConnectionGraph graph = graph_of(segments.segments, counts);
        InclusionSet set(scene, slopes, counts);
        std::size_t edges = 0;
        traverse(
            graph,
            segments,
            set,
            nullptr,
            [&](std::uint32_t vertex,
                const ConnectionGraph::Edge& edge,
                const InclusionSet& below) {
                ++edges;
                const SweepPoint& from = graph.vertices[vertex].point;
                const SweepPoint& to = graph.vertices[edge.end].point;
                const NearnessPlace middle = {0.5 * (from.x + to.x), 0.5 * (from.y + to.y)};
                const auto& [begin, end] = segments.segments[edge.segment];
                std::vector<std::uint32_t> expected;
                for (std::uint32_t i = 0; i < scene.triangles.size(); ++i)
                    if (covers_below(
                            corners_of(scene, scene.triangles[i]), middle, step(begin, end)))
                        expected.push_back(i);
                const auto found = below.triangles();
                EXPECT_TRUE(std::is_permutation(
                    found.begin(), found.end(), expected.begin(), expected.end()));
                for (std::size_t i = 1; i < found.size(); ++i)
                    EXPECT_EQ(
                        triangle_order(scene, slopes, found[i - 1], found[i]), FrontOrder::first);
            });
        EXPECT_EQ(edges, graph.edges.size());
        EXPECT_TRUE(set.triangles().empty());
        EXPECT_EQ(set.changes(), 0U);
    }
}

} // namespace
} // namespace vera
