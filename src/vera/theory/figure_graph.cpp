// SPDX-License-Identifier: Apache-2.0
// Figures A1 and A2: the connection graph of the appendix.
#include "vera/theory/diagram.h"
#include "vera/theory/figures.h"
#include "vera/visible/connection_graph.h"
#include "vera/visible/inclusion_set.h"
#include "vera/visible/plane_sweep.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace vera {

namespace {

/// Steps of the grid for each unit of the figures, which are drawn by hand from 0 to 100.
constexpr std::int32_t unit = screen_size / 100;
constexpr std::int64_t depth_unit = depth_size / 4000;

/// A corner: x, y and nearness, in units.
struct Corner {
    int x = 0;
    int y = 0;
    int nearness = 0;
};

struct FigurePolygon {
    std::vector<Corner> corners; ///< of a convex polygon, in a plane
    const char* color = "";
};

/// The sum of two steps from the corner.
Corner moved(Corner corner, Corner step) {
    return {corner.x + step.x, corner.y + step.y, corner.nearness + step.nearness};
}

FigurePolygon parallelogram(Corner corner, Corner first, Corner second, const char* color) {
    return {
        {corner, moved(corner, first), moved(moved(corner, first), second), moved(corner, second)},
        color};
}

/// The three faces of a box that are seen, from its nearest corner at the bottom.
void add_box(
    std::vector<FigurePolygon>& polygons,
    Corner corner,
    Corner right,
    Corner left,
    Corner up,
    const std::array<const char*, 3>& colors) {
    polygons.push_back(parallelogram(corner, right, up, colors[0]));
    polygons.push_back(parallelogram(corner, left, up, colors[1]));
    polygons.push_back(parallelogram(moved(corner, up), right, left, colors[2]));
}

/// The two faces of a pyramid that are seen.
void add_pyramid(
    std::vector<FigurePolygon>& polygons,
    Corner apex,
    const std::array<Corner, 3>& base,
    const std::array<const char*, 2>& colors) {
    polygons.push_back({{base[0], base[1], apex}, colors[0]});
    polygons.push_back({{base[1], base[2], apex}, colors[1]});
}

/// 8 quadrangles and 6 triangles: a floor, two boxes, a plate before them, and three pyramids, of
/// which two stand by themselves.
std::vector<FigurePolygon> polygons_of_scene() {
    std::vector<FigurePolygon> polygons;
    polygons.push_back(parallelogram({3, 7, 100}, {64, -3, 0}, {28, 30, 0}, "#dfe6ec"));
    add_box(
        polygons,
        {56, 21, 900},
        {14, 5, -100},
        {-13, 8, -100},
        {0, 36, 0},
        {"#8fb8d8", "#5f93bd", "#b9d5ea"});
    add_box(
        polygons,
        {23, 12, 1500},
        {17, 6, -100},
        {-13, 7, -100},
        {0, 22, 0},
        {"#f0bd8a", "#d9965a", "#f8dcbc"});
    polygons.push_back(parallelogram({36, 42, 2600}, {29, -7, 0}, {3, 13, 0}, "#9fd3b6"));
    add_pyramid(
        polygons,
        {81, 53, 2000},
        {{{70, 25, 2000}, {83, 16, 2200}, {93, 28, 2000}}},
        {"#c9a0c4", "#e2c6de"});
    add_pyramid(
        polygons,
        {17, 74, 2000},
        {{{5, 53, 2000}, {16, 47, 2200}, {29, 56, 2000}}},
        {"#d8c25a", "#efe19b"});
    add_pyramid(
        polygons,
        {80, 80, 2000},
        {{{69, 69, 2000}, {79, 64, 2200}, {92, 70, 2000}}},
        {"#a3a9b0", "#cdd2d7"});
    return polygons;
}

std::size_t edges_of(const std::vector<FigurePolygon>& polygons) {
    std::size_t edges = 0;
    for (const FigurePolygon& polygon : polygons)
        edges += polygon.corners.size();
    return edges;
}

ScreenPoint grid_point(Corner corner) {
    return {corner.x * unit, corner.y * unit};
}

/// Each polygon a fan of triangles, all of one source.
ScreenScene scene_of(const std::vector<FigurePolygon>& polygons) {
    ScreenScene scene;
    for (std::size_t i = 0; i < polygons.size(); ++i) {
        const auto first = static_cast<std::uint32_t>(scene.vertices.size());
        const std::vector<Corner>& corners = polygons[i].corners;
        for (const Corner corner : corners)
            scene.vertices.push_back({grid_point(corner), corner.nearness * depth_unit});
        for (std::uint32_t k = 2; k < corners.size(); ++k)
            add_triangle(scene, {first, first + k - 1, first + k}, static_cast<std::uint32_t>(i));
    }
    return scene;
}

/// The sides of the polygons, each once, from left to right.
std::vector<SweepSegments::Segment> segments_of(const std::vector<FigurePolygon>& polygons) {
    std::set<std::pair<ScreenPoint, ScreenPoint>> found;
    for (const FigurePolygon& polygon : polygons)
        for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
            const ScreenPoint from = grid_point(polygon.corners[i]);
            const ScreenPoint to = grid_point(polygon.corners[(i + 1) % polygon.corners.size()]);
            found.insert(std::minmax(from, to));
        }
    std::vector<SweepSegments::Segment> segments;
    for (const auto& [begin, end] : found)
        segments.push_back({begin, end});
    return segments;
}

/// What of the grid's plane a panel shows, each unit so many pixels.
DiagramPlane panel(DrawingPoint origin, double pixels) {
    return {origin, pixels / unit, pixels / unit};
}

DrawingPoint place_of(const DiagramPlane& plane, const SweepPoint& point) {
    return plane.place(point.x, point.y);
}

void draw_seen(
    Diagram& diagram,
    const DiagramPlane& plane,
    const std::vector<FigurePolygon>& polygons,
    const VisibleMap& map) {
    // Rings that run against those around them are holes; here one lies in the other only where
    // something else is seen there, which is drawn later.
    std::vector<std::size_t> order(map.rings.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return doubled_area(map, map.rings[a]) > doubled_area(map, map.rings[b]);
    });
    for (const std::size_t i : order) {
        const VisibleMap::Ring& ring = map.rings[i];
        if (doubled_area(map, ring) < 0)
            continue;
        std::vector<DrawingPoint> points;
        for (const std::uint32_t vertex : map.vertices_of(ring))
            points.push_back(plane.place(map.vertices[vertex].x(), map.vertices[vertex].y()));
        diagram.polygon(points, polygons[ring.source].color, {diagram_colors::ink, 1.2});
    }
}

/// What a graph's drains are: edges of the graph, and lines of their own.
struct Drains {
    std::size_t natural = 0;
    std::size_t artificial = 0;
};

constexpr DiagramPen plain_edge = {"#9aa5b1", 1.1};
constexpr DiagramPen natural_drain = {diagram_colors::blue, 2.2};
constexpr DiagramPen artificial_drain = {diagram_colors::orange, 2.2, "5 3"};

void draw_vertices(Diagram& diagram, const DiagramPlane& plane, const ConnectionGraph& graph) {
    for (std::uint32_t vertex = 0; vertex < graph.vertex_count(); ++vertex) {
        const SweepPoint& point = graph.vertices[vertex].point;
        diagram.circle(
            place_of(plane, point),
            point.is_crossing() ? 2.6 : 3.2,
            point.is_crossing() ? "#ffffff" : diagram_colors::ink,
            {diagram_colors::ink, 1});
    }
}

Drains draw_graph(Diagram& diagram, const DiagramPlane& plane, const ConnectionGraph& graph) {
    Drains drains;
    const auto at = [&](std::uint32_t vertex) {
        return place_of(plane, graph.vertices[vertex].point);
    };
    for (const bool of_drains : {false, true})
        for (std::uint32_t vertex = 0; vertex < graph.vertex_count(); ++vertex) {
            const auto edges = graph.edges_of(vertex);
            for (std::size_t i = 0; i < edges.size(); ++i) {
                const std::size_t edge = graph.vertices[vertex].first_edge + i;
                const bool is_drain = graph.vertices[edges[i].end].drain == edge;
                if (is_drain != of_drains)
                    continue;
                drains.natural += is_drain ? 1 : 0;
                diagram.line(at(vertex), at(edges[i].end), is_drain ? natural_drain : plain_edge);
            }
            for (const std::uint32_t from : graph.gaps_of(vertex))
                if (of_drains && from != ConnectionGraph::none) {
                    ++drains.artificial;
                    diagram.line(at(vertex), at(from), artificial_drain);
                }
        }
    draw_vertices(diagram, plane, graph);
    return drains;
}

void add_key(Diagram& diagram, DrawingPoint place) {
    const struct {
        DiagramPen pen;
        const char* text;
    } entries[] = {
        {natural_drain, "natural drain: the steepest edge from the left"},
        {artificial_drain, "drain line of its own"},
        {plain_edge, "other edge"}};

    for (const auto& [pen, text] : entries) {
        diagram.line({place.x, place.y - 4}, {place.x + 26, place.y - 4}, pen);
        diagram.text({place.x + 34, place.y}, text);
        place.y += 19;
    }
    diagram.circle({place.x + 6, place.y - 4}, 3.2, diagram_colors::ink);
    diagram.circle({place.x + 20, place.y - 4}, 2.6, "#ffffff", {diagram_colors::ink, 1});
    diagram.text({place.x + 34, place.y}, "end of edges, and crossing");
}

/// Keeps no polygons: only the order of edges is asked for.
struct NoSet {
    std::size_t changes() const { return 0; }

    void go_up(std::span<const SweepSegments::Border>, const std::array<NearnessPlace, 2>&) {}

    void take_back(std::size_t) {}
};

/// Three segments through one point, and some round it.
std::vector<SweepSegments::Segment> segments_of_star() {
    constexpr std::array<std::array<ScreenPoint, 2>, 7> ways = {{
        {{{10, 22}, {90, 78}}},
        {{{6, 50}, {94, 50}}},
        {{{14, 76}, {86, 24}}},
        {{{62, 6}, {80, 62}}},
        {{{20, 90}, {82, 84}}},
        {{{28, 8}, {62, 6}}},
        {{{28, 8}, {22, 60}}},
    }};
    std::vector<SweepSegments::Segment> segments;
    for (const auto& [a, b] : ways) {
        const ScreenPoint from = {a.x * unit, a.y * unit};
        const ScreenPoint to = {b.x * unit, b.y * unit};
        segments.push_back({std::min(from, to), std::max(from, to)});
    }
    return segments;
}

/// The vertex at the point, which there must be.
std::uint32_t vertex_at(const ConnectionGraph& graph, ScreenPoint point) {
    std::uint32_t nearest = 0;
    const auto distance = [&](std::uint32_t vertex) {
        const SweepPoint& at = graph.vertices[vertex].point;
        return std::abs(at.x - point.x) + std::abs(at.y - point.y);
    };
    for (std::uint32_t vertex = 1; vertex < graph.vertex_count(); ++vertex)
        if (distance(vertex) < distance(nearest))
            nearest = vertex;
    return nearest;
}

/// An edge, and its number in the order in which it is first passed.
struct PassedEdge {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    bool is_drain = false;
};

std::vector<PassedEdge>
passed_edges(const ConnectionGraph& graph, const std::vector<SweepSegments::Segment>& segments) {
    SweepSegments bare;
    bare.segments = segments;
    bare.starts.assign(segments.size() + 1, 0);
    NoSet set;
    std::vector<PassedEdge> passed;
    traverse(
        graph,
        bare,
        set,
        nullptr,
        [&](std::uint32_t vertex, const ConnectionGraph::Edge& edge, const NoSet&) {
            const auto number = static_cast<std::uint32_t>(&edge - graph.edges.data());
            passed.push_back({vertex, edge.end, graph.vertices[edge.end].drain == number});
        });
    return passed;
}

DrawingPoint between(DrawingPoint from, DrawingPoint to, double part) {
    return {from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)};
}

/// The head of an arrow at its tip.
void draw_tip(Diagram& diagram, DrawingPoint from, DrawingPoint tip, const char* color) {
    const double length = std::hypot(tip.x - from.x, tip.y - from.y);
    const DrawingPoint way = {(tip.x - from.x) / length, (tip.y - from.y) / length};
    const std::array<DrawingPoint, 3> head = {
        tip,
        DrawingPoint{tip.x - 9 * way.x - 4 * way.y, tip.y - 9 * way.y + 4 * way.x},
        DrawingPoint{tip.x - 9 * way.x + 4 * way.y, tip.y - 9 * way.y - 4 * way.x}};
    diagram.polygon(head, color);
}

/// A number in a circle.
void draw_number(Diagram& diagram, DrawingPoint place, std::size_t number, const char* color) {
    diagram.circle(place, 8.5, "#ffffff", {color, 1.2});
    diagram.text({place.x, place.y + 3.6}, std::to_string(number), {10, color, "middle", true});
}

/// The edges with their numbers in the order of the traversal.
void draw_passed(
    Diagram& diagram,
    const DiagramPlane& plane,
    const ConnectionGraph& graph,
    const std::vector<PassedEdge>& passed) {
    const auto at = [&](std::uint32_t vertex) {
        return place_of(plane, graph.vertices[vertex].point);
    };
    for (const PassedEdge& edge : passed)
        diagram.line(at(edge.from), at(edge.to), edge.is_drain ? natural_drain : plain_edge);
    for (std::uint32_t vertex = 0; vertex < graph.vertex_count(); ++vertex)
        for (const std::uint32_t from : graph.gaps_of(vertex))
            if (from != ConnectionGraph::none)
                diagram.line(at(vertex), at(from), artificial_drain);
    for (std::size_t i = 0; i < passed.size(); ++i) {
        const DrawingPoint from = at(passed[i].from);
        const DrawingPoint to = at(passed[i].to);
        const char* const color = passed[i].is_drain ? diagram_colors::blue : diagram_colors::faint;
        draw_tip(diagram, from, between(from, to, 0.62), color);
        draw_number(diagram, between(from, to, 0.42), i + 1, color);
    }
    draw_vertices(diagram, plane, graph);
}

} // namespace

DrawnFigure figure_of_connection_graph() {
    const std::vector<FigurePolygon> polygons = polygons_of_scene();
    const ScreenScene scene = scene_of(polygons);
    const VisibleMap map = visible_map(scene, plane_sweep(scene));
    const std::vector<SweepSegments::Segment> segments = segments_of(polygons);
    PlaneSweepCounts counts;
    const ConnectionGraph graph = connection_graph(segments, 0, counts);

    Diagram diagram(1120, 640, "Figure A1: a scene and its connection graph");
    const DiagramText heading = {15, diagram_colors::ink, "start", true};
    diagram.text({30, 30}, "The connection graph", heading);
    diagram.text({590, 30}, "The scene", heading);
    const Drains drains = draw_graph(diagram, panel({26, 480}, 5.2), graph);
    const DrawingPoint root = place_of(panel({26, 480}, 5.2), graph.vertices[0].point);
    diagram.circle(root, 6.5, "none", {diagram_colors::orange, 2});
    diagram.text({root.x - 8, root.y + 22}, "root");
    draw_seen(diagram, panel({586, 480}, 5.2), polygons, map);
    add_key(diagram, {30, 540});

    DrawnFigure figure;
    figure.counts = {
        {"polygons", polygons.size()},
        {"edges of polygons", edges_of(polygons)},
        {"segments", segments.size()},
        {"vertices", graph.vertex_count()},
        {"crossings", static_cast<std::size_t>(counts.crossings)},
        {"edges", graph.edges.size()},
        {"natural drains", drains.natural},
        {"drain lines", drains.artificial},
        {"regions seen", map.regions.size()}};
    const std::vector<std::string> caption = {
        fmt::format(
            "{} polygons with {} edges, {} of them different.",
            polygons.size(),
            edges_of(polygons),
            segments.size()),
        fmt::format(
            "The graph has {} vertices, {} of them crossings, and {} edges.",
            graph.vertex_count(),
            counts.crossings,
            graph.edges.size()),
        fmt::format(
            "{} natural drains and {} drain lines: a way back to the root",
            drains.natural,
            drains.artificial),
        "from every vertex, always to the left. Parts of",
        fmt::format("{} polygons are seen.", map.regions.size())};
    diagram.lines({590, 540}, caption);
    figure.svg = diagram.svg();
    return figure;
}

DrawnFigure figure_of_traversal() {
    const std::vector<SweepSegments::Segment> segments = segments_of_star();
    PlaneSweepCounts counts;
    const ConnectionGraph graph = connection_graph(segments, 0, counts);
    const std::vector<PassedEdge> passed = passed_edges(graph, segments);
    const std::uint32_t vertex = vertex_at(graph, {50 * unit, 50 * unit});

    Diagram diagram(960, 640, "Figure A2: how the connection graph is traversed");
    diagram.text(
        {30, 30}, "The way through a connection graph", {15, diagram_colors::ink, "start", true});
    const DiagramPlane plane = panel({40, 580}, 5.4);
    draw_passed(diagram, plane, graph, passed);

    // What meets in V: those from the left as they are passed, which is from below.
    std::vector<std::size_t> coming;
    for (std::size_t i = 0; i < passed.size(); ++i)
        if (passed[i].to == vertex)
            coming.push_back(i);
    const DrawingPoint at = place_of(plane, graph.vertices[vertex].point);
    diagram.circle(at, 6, "#ffffff", {diagram_colors::ink, 2});
    diagram.text({at.x - 5, at.y - 16}, "V", {17, diagram_colors::ink, "start", true});
    std::vector<std::string> caption = {
        "Numbers: the order in which edges are passed",
        "from left to right. Each is passed once more,",
        "on the way back.",
        ""};
    std::size_t number = 1;
    std::size_t drain = 0;
    std::vector<std::string> others;
    for (const std::size_t i : coming) {
        // The drain is e_1, whichever is passed first.
        const std::size_t name = passed[i].is_drain ? 1 : ++number;
        const DrawingPoint from = place_of(plane, graph.vertices[passed[i].from].point);
        const DrawingPoint label = between(from, at, 0.72);
        diagram.text(
            {label.x - 4, label.y - 8},
            fmt::format("e_{}", name),
            {15, diagram_colors::ink, "middle", true});
        if (passed[i].is_drain)
            drain = i + 1;
        else
            others.push_back(fmt::format("e_{} (number {})", name, i + 1));
    }
    const auto leaving = graph.edges_of(vertex).size();
    caption.push_back(fmt::format("V is reached by {}", others.empty() ? "" : others.front()));
    for (std::size_t i = 1; i < others.size(); ++i)
        caption.push_back(fmt::format("and by {}:", others[i]));
    caption.insert(
        caption.end(),
        {"the traversal returns at once.",
         fmt::format("By its drain e_1 (number {})", drain),
         fmt::format("all {} edges to the right of V", leaving),
         "are passed one after the other, from below,",
         "and all that is reached by their drains."});
    diagram.lines({590, 90}, caption);
    add_key(diagram, {590, 400});

    DrawnFigure figure;
    figure.counts = {
        {"edges", graph.edges.size()},
        {"passed", passed.size()},
        {"edges to V", coming.size()},
        {"edges from V", leaving},
        {"number of the drain", drain}};
    figure.svg = diagram.svg();
    return figure;
}

} // namespace vera
