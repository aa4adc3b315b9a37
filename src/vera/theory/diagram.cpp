// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/diagram.h"

#include "vera/drawing/document_text.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace vera {

namespace {

/// To a tenth, without a nothing behind the point: "12.5", "12".
std::string number(double value) {
    std::string text = fmt::format("{:.1f}", value);
    if (text.ends_with(".0"))
        text.resize(text.size() - 2);
    return text == "-0" ? "0" : text;
}

std::string points_text(std::span<const DrawingPoint> points) {
    std::string text;
    for (const DrawingPoint& point : points)
        text += fmt::format("{}{},{}", text.empty() ? "" : " ", number(point.x), number(point.y));
    return text;
}

std::string pen_text(const DiagramPen& pen) {
    if (std::string_view(pen.color) == "none")
        return R"(stroke="none")";
    std::string text = fmt::format(
        R"(stroke="{}" stroke-width="{}" stroke-linejoin="round")", pen.color, number(pen.width));
    if (*pen.dashes != '\0')
        text += fmt::format(R"( stroke-dasharray="{}")", pen.dashes);
    return text;
}

/// The words, those behind '^' and '_' in spans of their own.
std::string raised_and_lowered(std::string_view text, double size) {
    std::string result;
    while (!text.empty()) {
        const std::size_t mark = text.find_first_of("^_");
        result += detail::xml_text(text.substr(0, mark));
        if (mark == std::string_view::npos)
            break;
        const double shift = text[mark] == '^' ? -0.35 * size : 0.25 * size;
        text.remove_prefix(mark + 1);
        const std::size_t end = std::min(text.find_first_of(" ,()"), text.size());
        result += fmt::format(
            R"(<tspan dy="{}" font-size="{}">{}</tspan>)",
            number(shift),
            number(0.75 * size),
            detail::xml_text(text.substr(0, end)));
        text.remove_prefix(end);
        if (text.empty())
            break;
        // What follows stands on the line again. A shift takes a letter to hold it.
        result += fmt::format(
            R"(<tspan dy="{}">{}</tspan>)", number(-shift), detail::xml_text(text.substr(0, 1)));
        text.remove_prefix(1);
    }
    return result;
}

} // namespace

Diagram::Diagram(double width, double height, std::string_view title) {
    text_ = fmt::format(
        R"(<?xml version="1.0" encoding="UTF-8"?>
<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}" viewBox="0 0 {0} {1}" )"
        R"(font-family="DejaVu Sans, Verdana, Helvetica, Arial, sans-serif" xml:space="preserve">
<title>{2}</title>
<rect width="{0}" height="{1}" fill="#ffffff"/>
)",
        number(width),
        number(height),
        detail::xml_text(title));
}

void Diagram::line(DrawingPoint from, DrawingPoint to, const DiagramPen& pen) {
    text_ += fmt::format(
        "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" {}/>\n",
        number(from.x),
        number(from.y),
        number(to.x),
        number(to.y),
        pen_text(pen));
}

void Diagram::polyline(std::span<const DrawingPoint> points, const DiagramPen& pen) {
    text_ += fmt::format(
        "<polyline points=\"{}\" fill=\"none\" {}/>\n", points_text(points), pen_text(pen));
}

void Diagram::polygon(
    std::span<const DrawingPoint> points, const char* fill, const DiagramPen& pen) {
    text_ += fmt::format(
        "<polygon points=\"{}\" fill=\"{}\" {}/>\n", points_text(points), fill, pen_text(pen));
}

void Diagram::circle(DrawingPoint center, double radius, const char* fill, const DiagramPen& pen) {
    text_ += fmt::format(
        "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\" {}/>\n",
        number(center.x),
        number(center.y),
        number(radius),
        fill,
        pen_text(pen));
}

void Diagram::text(DrawingPoint place, std::string_view text, const DiagramText& style) {
    text_ += fmt::format(
        R"(<text x="{}" y="{}" font-size="{}" text-anchor="{}" fill="{}")",
        number(place.x),
        number(place.y),
        number(style.size),
        style.anchor,
        style.color);
    if (style.bold)
        text_ += R"( font-weight="bold")";
    if (style.turn_degrees != 0)
        text_ += fmt::format(
            " transform=\"rotate({} {} {})\"",
            number(style.turn_degrees),
            number(place.x),
            number(place.y));
    text_ += fmt::format(">{}</text>\n", raised_and_lowered(text, style.size));
}

void Diagram::lines(
    DrawingPoint place, std::span<const std::string> lines, const DiagramText& style) {
    for (const std::string& line : lines) {
        text(place, line, style);
        place.y += 1.5 * style.size;
    }
}

std::string Diagram::svg() {
    return std::exchange(text_, {}) + "</svg>\n";
}

} // namespace vera
