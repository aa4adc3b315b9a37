// SPDX-License-Identifier: Apache-2.0
// Figure B1: windows over each other, and what is seen of them.
#include "vera/theory/diagram.h"
#include "vera/theory/figures.h"
#include "vera/theory/rectangle_view.h"
#include "vera/visible/plane_sweep.h"

#include <algorithm>
#include <array>
#include <random>
#include <set>

#include <fmt/format.h>

namespace vera {

namespace {

struct WindowColors {
    const char* bar;
    const char* area;
};

constexpr std::array<WindowColors, 6> colors = {{
    {"#5f93bd", "#d5e5f2"},
    {"#d9965a", "#f9e6d2"},
    {"#6fae8c", "#d8eee2"},
    {"#b583ae", "#eedcec"},
    {"#c9ac3a", "#f6eec6"},
    {"#87919b", "#e3e7ea"},
}};

/// So many windows anywhere, the nearest first: of each the bar on top of it, in front of its area.
std::vector<IsoRectangle> windows(std::int32_t count) {
    std::mt19937_64 random(11);
    const auto any = [&](std::int32_t first, std::int32_t last) {
        return first
            + static_cast<std::int32_t>(random() % static_cast<std::uint64_t>(last - first + 1));
    };
    std::vector<IsoRectangle> made;
    for (std::int32_t i = 0; i < count; ++i) {
        const std::int32_t width = any(14, 46);
        const std::int32_t height = any(12, 38);
        const std::int32_t x = any(0, 100 - width);
        const std::int32_t y = any(0, 84 - height);
        made.push_back({2 * i, x, x + width, y + height - 4, y + height});
        made.push_back({2 * i + 1, x, x + width, y, y + height});
    }
    return made;
}

const char* color_of(std::uint32_t rectangle) {
    const WindowColors& of_window = colors.at(rectangle / 2 % colors.size());
    return rectangle % 2 == 0 ? of_window.bar : of_window.area;
}

std::vector<DrawingPoint>
places_of(const DiagramPlane& plane, std::span<const PlanePoint> corners) {
    std::vector<DrawingPoint> places;
    for (const PlanePoint corner : corners)
        places.push_back(plane.place(corner.x, corner.y));
    return places;
}

void draw_sides(
    Diagram& diagram, const DiagramPlane& plane, const std::vector<IsoRectangle>& rectangles) {
    for (const IsoRectangle& each : rectangles) {
        const std::array<PlanePoint, 4> corners = {
            {{each.lower_x, each.lower_y},
             {each.upper_x, each.lower_y},
             {each.upper_x, each.upper_y},
             {each.lower_x, each.upper_y}}};
        diagram.polygon(places_of(plane, corners), "none", {diagram_colors::faint, 0.9});
    }
}

/// A ring leaves its first corner, the lowest of the leftmost, to the right; round a hole, upward.
bool is_hole(std::span<const PlanePoint> corners) {
    return corners[0].x == corners[1].x;
}

void draw_seen(Diagram& diagram, const DiagramPlane& plane, const RectangleView& view) {
    // Those behind come later in the list; what is seen in a hole lies in front.
    for (auto ring = view.rings.rbegin(); ring != view.rings.rend(); ++ring) {
        const auto corners = view.corners_of(*ring);
        if (!is_hole(corners))
            diagram.polygon(
                places_of(plane, corners), color_of(ring->rectangle), {diagram_colors::ink, 1.1});
    }
    for (const PlanePoint corner : view.corners)
        diagram.circle(plane.place(corner.x, corner.y), 1.7, diagram_colors::ink);
}

} // namespace

DrawnFigure figure_of_windows() {
    const std::vector<IsoRectangle> rectangles = windows(16);
    WindowCounts counts;
    const RectangleView view = rectangle_view(rectangles, &counts);
    PlaneSweepCounts swept;
    PlaneSweepSettings settings;
    settings.counts = &swept;
    plane_sweep(screen_scene(rectangles), settings);
    std::set<std::uint32_t> seen;
    std::size_t holes = 0;
    for (const RectangleView::Ring& ring : view.rings) {
        seen.insert(ring.rectangle);
        holes += is_hole(view.corners_of(ring)) ? 1 : 0;
    }

    Diagram diagram(1120, 560, "Figure B1: windows over each other, and what is seen of them");
    const DiagramText heading = {15, diagram_colors::ink, "start", true};
    diagram.text({30, 30}, "All sides", heading);
    diagram.text({590, 30}, "What is seen", heading);
    draw_sides(diagram, {{30, 470}, 5, 5}, rectangles);
    draw_seen(diagram, {{590, 470}, 5, 5}, view);
    diagram.lines(
        {30, 505},
        std::vector<std::string>{
            fmt::format(
                "{} windows, each a bar and an area: {} rectangles.",
                rectangles.size() / 2,
                rectangles.size()),
            fmt::format("Their sides cross in {} points.", swept.crossings)});
    diagram.lines(
        {590, 505},
        std::vector<std::string>{
            fmt::format("Something is seen of {} rectangles,", seen.size()),
            fmt::format("with {} corners in {} rings.", view.corners.size(), view.rings.size())});

    DrawnFigure figure;
    figure.counts = {
        {"rectangles", rectangles.size()},
        {"crossings", static_cast<std::size_t>(swept.crossings)},
        {"rectangles seen", seen.size()},
        {"rings", view.rings.size()},
        {"holes", holes},
        {"corners seen", view.corners.size()}};
    figure.svg = diagram.svg();
    return figure;
}

} // namespace vera
