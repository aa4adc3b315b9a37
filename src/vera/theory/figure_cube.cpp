// SPDX-License-Identifier: Apache-2.0
// Figure 3a: what is seen from a point, on the six faces of a cube round it.
#include "vera/theory/diagram.h"
#include "vera/theory/figures.h"
#include "vera/visible/map_locator.h"
#include "vera/visible/plane_sweep.h"
#include "vera/visible/projection.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace vera {

namespace {

/// A face of the cube, as the view point sees it: its middle, and ways to its right and upper side.
struct CubeFace {
    const char* name;
    Vec3 middle;
    Vec3 right;
    Vec3 up;
    int column = 0; ///< of the cube, unfolded
    int row = 0;
};

constexpr std::array<CubeFace, 6> faces = {{
    {"left", {-1, 0, 0}, {0, 0, -1}, {0, 1, 0}, 0, 1},
    {"front", {0, 0, -1}, {1, 0, 0}, {0, 1, 0}, 1, 1},
    {"right", {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 2, 1},
    {"back", {0, 0, 1}, {-1, 0, 0}, {0, 1, 0}, 3, 1},
    {"above", {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 1, 0},
    {"below", {0, -1, 0}, {1, 0, 0}, {0, 0, -1}, 1, 2},
}};

constexpr std::size_t front = 1;

struct CubePolygon {
    std::vector<Vec3> corners; ///< convex, in a plane
    const char* color;
};

/// Round the view point, which is the origin: a floor, walls, boxes before them, and what hangs
/// above.
const std::vector<CubePolygon>& polygons() {
    static const std::vector<CubePolygon> all = {
        {{{-6, -2, 6}, {6, -2, 6}, {6, -2, -6}, {-6, -2, -6}}, "#dfe6ec"},
        {{{-4, -2, -5}, {5, -2, -5}, {5, 3, -5}, {-4, 3, -5}}, "#b9d5ea"},
        {{{-1.8, -2, -3.4}, {0.2, -2, -3}, {0.2, 0.4, -3}, {-1.8, 0.4, -3.4}}, "#f0bd8a"},
        {{{0.2, -2, -3}, {1.2, -2, -4.2}, {1.2, 0.4, -4.2}, {0.2, 0.4, -3}}, "#d9965a"},
        {{{0.5, 1, -2.4}, {2.6, 1.4, -2.2}, {1.7, 2.6, -2.6}}, "#9fd3b6"},
        {{{5, -2, -5}, {5, -2, 3}, {5, 4, 3}, {5, 4, -5}}, "#8fb8d8"},
        {{{3, -2, 1.2}, {3.4, -2, -1.2}, {3.2, 1.6, 0}}, "#d8c25a"},
        {{{-5, -2, 2}, {-5, -2, -4}, {-5, 2.4, -1}}, "#c9a0c4"},
        {{{-2.2, 3, -1.6}, {1.6, 3, -1.6}, {1.6, 3, 1.2}, {-2.2, 3, 1.2}}, "#f3d7da"},
        {{{-1, 2, 0.6}, {0.2, 2.2, -1}, {1, 2, 0.8}}, "#e08a90"},
        {{{2.2, -1.4, 3.6}, {-2.4, -1.4, 3.6}, {-0.4, 2.6, 4}}, "#a8c99b"},
        {{{-0.7, -1.4, 0.4}, {0.8, -1.4, 0.5}, {0.5, -1.4, -0.8}, {-0.8, -1.4, -0.6}}, "#a3a9b0"},
    };
    return all;
}

Facets facets_of_polygons() {
    Facets facets;
    for (std::size_t i = 0; i < polygons().size(); ++i) {
        const auto first = static_cast<std::uint32_t>(facets.corners.size());
        const std::vector<Vec3>& corners = polygons()[i].corners;
        for (const Vec3& corner : corners)
            facets.corners.push_back(corner);
        for (std::uint32_t k = 2; k < corners.size(); ++k) {
            Facets::Triangle triangle;
            triangle.corners = {first, first + k - 1, first + k};
            triangle.primitive = i;
            facets.triangles.push_back(triangle);
        }
    }
    return facets;
}

VisibleMap map_of(const CubeFace& face, const Facets& facets) {
    Camera camera;
    camera.lower_left = face.middle - face.right - face.up;
    camera.lower_right = face.middle + face.right - face.up;
    camera.upper_left = face.middle - face.right + face.up;
    std::vector<std::uint32_t> sources;
    for (const Facets::Triangle& triangle : facets.triangles)
        sources.push_back(static_cast<std::uint32_t>(triangle.primitive));
    const ScreenScene scene = screen_scene(facets, CameraMap(camera), sources);
    return visible_map(scene, plane_sweep(scene));
}

/// The pixels of a face, from its upper left corner on: y grows downward, as it does on the grid.
DiagramPlane plane_of(const CubeFace& face, DrawingPoint corner, double side) {
    return {
        {corner.x + face.column * side, corner.y + face.row * side},
        side / screen_size,
        -side / screen_size};
}

void draw_face(
    Diagram& diagram, const DiagramPlane& plane, const CubeFace& face, const VisibleMap& map) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < map.rings.size(); ++i)
        if (doubled_area(map, map.rings[i]) > 0)
            order.push_back(i);
    // What is seen within something else is smaller.
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return doubled_area(map, map.rings[a]) > doubled_area(map, map.rings[b]);
    });
    for (const std::size_t i : order) {
        std::vector<DrawingPoint> points;
        for (const std::uint32_t vertex : map.vertices_of(map.rings[i]))
            points.push_back(plane.place(map.vertices[vertex].x(), map.vertices[vertex].y()));
        diagram.polygon(points, polygons()[map.rings[i].source].color, {diagram_colors::ink, 0.9});
    }
    const double most = screen_size;
    const std::array<DrawingPoint, 4> frame = {
        plane.place(0, 0), plane.place(most, 0), plane.place(most, most), plane.place(0, most)};
    diagram.polygon(frame, "none", {diagram_colors::ink, 1.8});
    const DrawingPoint corner = plane.place(0, 0);
    diagram.text(
        {corner.x + 7, corner.y + 17}, face.name, {12, diagram_colors::ink, "start", true});
}

/// The cube from outside, with a ray from its middle through the front face.
void draw_cube(Diagram& diagram, DrawingPoint middle, double size, Vec3 direction) {
    const auto place = [&](Vec3 point) {
        // What lies to the front, where z is negative, is drawn to the right and above.
        return DrawingPoint{
            middle.x + size * (point.x - 0.4 * point.z),
            middle.y - size * (point.y - 0.35 * point.z)};
    };
    constexpr std::array<std::array<double, 2>, 4> ends = {{{-1, -1}, {-1, 1}, {1, -1}, {1, 1}}};
    for (const auto& [a, b] : ends) {
        diagram.line(place({-1, a, b}), place({1, a, b}), {diagram_colors::faint, 1.3});
        diagram.line(place({a, -1, b}), place({a, 1, b}), {diagram_colors::faint, 1.3});
        diagram.line(place({a, b, -1}), place({a, b, 1}), {diagram_colors::faint, 1.3});
    }
    const DrawingPoint eye = place({0, 0, 0});
    const DrawingPoint hole = place(direction);
    diagram.line(eye, hole, {diagram_colors::orange, 2});
    diagram.line(hole, place(1.6 * direction), {diagram_colors::orange, 2, "5 3"});
    diagram.circle(eye, 4.5, diagram_colors::ink);
    diagram.text({eye.x - 18, eye.y + 5}, "A", {15, diagram_colors::ink, "start", true});
    diagram.circle(hole, 4.5, "#ffffff", {diagram_colors::orange, 2});
}

} // namespace

DrawnFigure figure_of_cube() {
    const Facets facets = facets_of_polygons();
    /// On the front face, which is where z is -1.
    const Vec3 direction = {0.44, 0.64, -1};
    const DrawingPoint corner = {40, 60};
    constexpr double side = 240;

    Diagram diagram(1040, 810, "Figure 3a: central ray queries as point location on six faces");
    diagram.text(
        {40, 34},
        "What is seen from A, on the faces of a cube round it",
        {15, diagram_colors::ink, "start", true});
    std::size_t regions = 0;
    std::uint32_t found = no_source;
    DrawingPoint query;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const CubeFace& face = faces.at(i);
        const VisibleMap map = map_of(face, facets);
        const DiagramPlane plane = plane_of(face, corner, side);
        draw_face(diagram, plane, face, map);
        regions += map.regions.size();
        if (i != front)
            continue;
        const double x = (1 + direction.x) / 2 * screen_size;
        const double y = (1 - direction.y) / 2 * screen_size;
        found = MapLocator(map).at(x, y).source;
        query = plane.place(x, y);
    }
    diagram.circle(query, 5, "#ffffff", {diagram_colors::orange, 2});
    draw_cube(diagram, {770, 185}, 62, direction);

    DrawnFigure figure;
    figure.counts = {
        {"polygons", polygons().size()},
        {"faces", faces.size()},
        {"regions", regions},
        {"polygon of the query", found}};
    const std::vector<std::string> caption = {
        fmt::format("{} polygons stand round A. The visible maps of", polygons().size()),
        fmt::format("the {} faces have {} regions.", faces.size(), regions),
        "",
        "A ray from A goes through a point of one face (orange).",
        "What it meets is the region that the point lies in:",
        "a ray query is a point location in the plane."};
    diagram.lines({550, 600}, caption);
    figure.svg = diagram.svg();
    return figure;
}

} // namespace vera
