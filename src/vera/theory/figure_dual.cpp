// SPDX-License-Identifier: Apache-2.0
// Figure 3c: a ray, moved in the dual space of its coefficients.
#include "vera/theory/diagram.h"
#include "vera/theory/dual_arrangement.h"
#include "vera/theory/figures.h"

#include <array>

#include <fmt/format.h>

namespace vera {

namespace {

/// A rectangle, seen along the y axis.
struct FigureSide {
    std::int32_t z = 0;
    std::int32_t lower = 0;
    std::int32_t upper = 0;
};

constexpr std::array<FigureSide, 5> sides = {
    {{1, 2, 5}, {3, 6, 9}, {4, 1, 3}, {6, 3, 8}, {8, 7, 10}}};

/// x = (z + 11) / 4.
constexpr SideView query = {{1, 4}, 11};

double x_of(const SideView& line, double z) {
    return (static_cast<double>(line.slope.rise) * z + static_cast<double>(line.height))
        / static_cast<double>(line.slope.run);
}

std::vector<DualLine> lines_of_sides() {
    std::vector<DualLine> lines;
    for (const FigureSide& side : sides) {
        lines.push_back({{side.z, side.lower}, false});
        lines.push_back({{side.z, side.upper}, true});
    }
    return lines;
}

bool passes(const SideView& line, const FigureSide& side) {
    return is_past(line, {{side.z, side.lower}, false})
        && !is_past(line, {{side.z, side.upper}, true});
}

const char* color_of(const DualLine& line) {
    return line.is_upper ? diagram_colors::orange : diagram_colors::blue;
}

void draw_axes(
    Diagram& diagram,
    const DiagramPlane& plane,
    DrawingPoint least,
    DrawingPoint most,
    const char* across,
    const char* upward) {
    diagram.line(plane.place(least.x, 0), plane.place(most.x, 0), {diagram_colors::faint, 1});
    diagram.line(plane.place(0, least.y), plane.place(0, most.y), {diagram_colors::faint, 1});
    const DrawingPoint right = plane.place(most.x, 0);
    const DrawingPoint top = plane.place(0, most.y);
    diagram.text({right.x + 8, right.y + 4}, across, {14});
    diagram.text({top.x - 4, top.y - 8}, upward, {14});
}

/// An arrow upward.
void draw_rise(Diagram& diagram, DrawingPoint from, DrawingPoint to) {
    diagram.line(from, {to.x, to.y + 8}, {diagram_colors::green, 2.2});
    const std::array<DrawingPoint, 3> head = {
        DrawingPoint{to.x, to.y + 1},
        DrawingPoint{to.x - 4.5, to.y + 10},
        DrawingPoint{to.x + 4.5, to.y + 10}};
    diagram.polygon(head, diagram_colors::green);
}

void draw_sides(
    Diagram& diagram, const DiagramPlane& plane, const SideView& moved, const DualLine& met) {
    draw_axes(diagram, plane, {-0.4, -0.4}, {9.6, 10.6}, "z", "x");
    for (const FigureSide& side : sides) {
        const DrawingPoint lower = plane.place(side.z, side.lower);
        const DrawingPoint upper = plane.place(side.z, side.upper);
        const bool passed = passes(query, side);
        diagram.line(lower, upper, {diagram_colors::ink, passed ? 4.5 : 2});
        diagram.circle(lower, 4, diagram_colors::blue);
        diagram.circle(upper, 4, diagram_colors::orange);
    }
    diagram.line(
        plane.place(0, x_of(query, 0)),
        plane.place(9.4, x_of(query, 9.4)),
        {diagram_colors::ink, 1.6});
    diagram.line(
        plane.place(0, x_of(moved, 0)),
        plane.place(9.4, x_of(moved, 9.4)),
        {diagram_colors::green, 1.8, "7 4"});
    draw_rise(diagram, plane.place(9.1, x_of(query, 9.1)), plane.place(9.1, x_of(moved, 9.1)));
    diagram.circle(plane.place(met.end.x, met.end.y), 7.5, "none", {diagram_colors::green, 2});
}

void draw_dual_lines(
    Diagram& diagram,
    const DiagramPlane& plane,
    const DualArrangement& arrangement,
    std::uint32_t met) {
    constexpr double least_a = -0.6;
    constexpr double most_a = 1.2;
    draw_axes(diagram, plane, {least_a, -2.4}, {most_a, 11.4}, "a", "b");
    for (std::uint32_t i = 0; i < arrangement.lines().size(); ++i) {
        const DualLine& line = arrangement.lines()[i];
        const auto b = [&](double a) { return line.end.y - a * line.end.x; };
        // Within the panel from below to above.
        double from = least_a;
        double to = most_a;
        for (double* const end : {&from, &to}) {
            if (b(*end) < -2.4)
                *end = (line.end.y + 2.4) / line.end.x;
            if (b(*end) > 11.4)
                *end = (line.end.y - 11.4) / line.end.x;
        }
        diagram.line(
            plane.place(from, b(from)),
            plane.place(to, b(to)),
            {color_of(line), i == met ? 3.2 : 1.1});
    }
}

} // namespace

DrawnFigure figure_of_dual_space() {
    const DualArrangement arrangement(lines_of_sides());
    DualCounts counts;
    const std::uint32_t met = arrangement.first_above(query, counts).value();
    const DualLine& end = arrangement.lines()[met];
    const SideView moved = {query.slope, height_at(end, query.slope)};

    Diagram diagram(1120, 640, "Figure 3c: a ray moved in dual space");
    const DiagramText heading = {15, diagram_colors::ink, "start", true};
    diagram.text({30, 30}, "Rectangles from the side, and a ray's line x = a z + b", heading);
    diagram.text({590, 30}, "Dual space: the line is a point, each end a line", heading);
    draw_sides(diagram, {{60, 500}, 45, 41}, moved, end);
    const DiagramPlane plane = {{770, 440}, 260, 33};
    draw_dual_lines(diagram, plane, arrangement, met);
    const double a = static_cast<double>(query.slope.rise) / static_cast<double>(query.slope.run);
    const DrawingPoint point = plane.place(a, x_of(query, 0));
    const DrawingPoint goal = plane.place(a, x_of(moved, 0));
    draw_rise(diagram, point, goal);
    diagram.circle(point, 5, diagram_colors::ink);
    diagram.circle(goal, 5, "#ffffff", {diagram_colors::green, 2});

    std::size_t before = 0;
    std::size_t after = 0;
    for (const FigureSide& side : sides) {
        before += passes(query, side) ? 1 : 0;
        after += passes(moved, side) ? 1 : 0;
    }
    DrawnFigure figure;
    figure.counts = {
        {"rectangles", sides.size()},
        {"lines", arrangement.lines().size()},
        {"crossings", arrangement.crossing_slopes().size()},
        {"passed", before},
        {"passed when moved", after},
        {"comparisons", static_cast<std::size_t>(counts.comparisons)}};
    const std::vector<std::string> left = {
        "The line (black) rises until it meets the end of a side (green).",
        fmt::format("It passes {} rectangles (thick), before and after.", before)};
    const std::vector<std::string> right = {
        fmt::format(
            "{} lines: of lower ends (blue) and upper ones (orange). Their order",
            arrangement.lines().size()),
        fmt::format(
            "changes at {} slopes. The first line above the point is found",
            arrangement.crossing_slopes().size()),
        fmt::format("by {} comparisons.", counts.comparisons)};
    diagram.lines({30, 560}, left);
    diagram.lines({590, 560}, right);
    figure.svg = diagram.svg();
    return figure;
}

} // namespace vera
