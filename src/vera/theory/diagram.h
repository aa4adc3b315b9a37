// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing.h"

#include <span>
#include <string>
#include <string_view>

namespace vera {

/// Colours that the colour-blind tell apart (Okabe and Ito 2008), and those of frames.
namespace diagram_colors {
constexpr const char* ink = "#1c2833";
constexpr const char* faint = "#5d6d7e";
constexpr const char* grid = "#e3e7eb";
constexpr const char* blue = "#0072b2";
constexpr const char* orange = "#d55e00";
constexpr const char* green = "#009e73";
constexpr const char* purple = "#cc79a7";
constexpr const char* gold = "#e69f00";
constexpr const char* sky = "#56b4e9";
} // namespace diagram_colors

/// How a line, or the border of an area, is drawn.
struct DiagramPen {
    const char* color = diagram_colors::ink; ///< "none" for no line
    double width = 1;                        ///< in pixels
    const char* dashes = "";                 ///< "6 4": lengths of dash and gap; none: unbroken
};

struct DiagramText {
    double size = 12; ///< in pixels
    const char* color = diagram_colors::ink;
    const char* anchor = "start"; ///< or "middle" or "end": what of it lies at the place
    bool bold = false;
    double turn_degrees = 0; ///< clockwise, about the place
};

/// Where the numbers of a plane, whose y grows upward, are drawn.
struct DiagramPlane {
    DrawingPoint origin; ///< of the plane, in pixels
    double pixels_x = 1; ///< for each unit
    double pixels_y = 1;

    DrawingPoint place(double x, double y) const {
        return {origin.x + x * pixels_x, origin.y - y * pixels_y};
    }
};

/// Lines, areas and words on a white page, one upon the other, as SVG. Coordinates are in pixels,
/// of which y grows downward, and are written to a tenth of one. The same calls give the same
/// bytes.
class Diagram {
public:
    Diagram(double width, double height, std::string_view title);

    void line(DrawingPoint from, DrawingPoint to, const DiagramPen& pen = {});
    void polyline(std::span<const DrawingPoint> points, const DiagramPen& pen = {});
    void polygon(
        std::span<const DrawingPoint> points, const char* fill, const DiagramPen& pen = {"none"});
    void
    circle(DrawingPoint center, double radius, const char* fill, const DiagramPen& pen = {"none"});

    /// What stands behind a '^', up to the next space, comma or bracket, is raised; behind a '_'
    /// lowered.
    void text(DrawingPoint place, std::string_view text, const DiagramText& style = {});

    /// Lines of text below each other, from that place on.
    void
    lines(DrawingPoint place, std::span<const std::string> lines, const DiagramText& style = {});

    /// Ends the document; afterwards the diagram is empty.
    std::string svg();

private:
    std::string text_;
};

} // namespace vera
