// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing_file.h"

#include <memory>
#include <string>

namespace vera {

inline std::shared_ptr<const DrawingGroup> group_named(const std::string& name) {
    return std::make_shared<const DrawingGroup>(DrawingGroup{.id = name, .name = name});
}

/// Two squares side by side, the left one with a hole, in one group; a triangle beside it; and
/// lines of two classes.
inline Drawing sample_drawing() {
    const auto squares = group_named("squares");
    Drawing drawing;
    drawing.width = 40;
    drawing.height = 30;
    drawing.title = "Two & more";
    drawing.description = "squares";
    drawing.background = DrawingColor{255, 255, 255};
    drawing.fills = {
        {.id = "left",
         .name = "a <square>",
         .group = squares,
         .color = {255, 0, 0},
         .rings = {{{1, 1}, {11, 1}, {11, 11}, {1, 11}}, {{2, 2}, {2, 3.5}, {3.254, 3.5}}},
         .seams = {{{11, 1}, {11, 11}}}},
        {.group = squares,
         .color = {18, 52, 86},
         .rings = {{{11, 1}, {21, 1}, {21, 11}, {11, 11}}}},
        {.color = {0, 0, 255}, .rings = {{{0.5, -0.25}, {0.75, 0.5}, {1.5, 0.75}}}}};
    drawing.strokes = {
        {.line_class = LineClass::hidden, .points = {{0, 0}, {10, 5}}},
        {.line_class = LineClass::silhouette,
         .points = {{1, 1}, {21, 1}, {21, 11}, {1, 11}},
         .closed = true},
        {.line_class = LineClass::hidden, .points = {{5, 5}, {5, 10}}}};
    return drawing;
}

/// Two squares of one linear gradient, the first with a seam, and one of a radial one.
inline Drawing drawing_of_gradients() {
    Gradient linear;
    linear.start = {1, 1};
    linear.axis = {10, 0};
    linear.stops = {{0, {255, 0, 0}}, {1, {0, 0, 255}}};
    Gradient radial;
    radial.shape = Gradient::Shape::radial;
    radial.start = {10, 20};
    radial.axis = {4, 3};
    radial.other_axis = {-1.5, 2};
    radial.stops = {{0.25, {255, 255, 255}}, {0.5, {0, 255, 0}}, {1, {0, 0, 0}}};

    Drawing drawing;
    drawing.width = 40;
    drawing.height = 30;
    drawing.fills = {
        {.gradient = linear,
         .rings = {{{1, 1}, {6, 1}, {6, 11}, {1, 11}}},
         .seams = {{{6, 1}, {6, 11}}}},
        {.gradient = linear, .rings = {{{6, 1}, {11, 1}, {11, 11}, {6, 11}}}},
        {.gradient = radial, .rings = {{{5, 15}, {15, 15}, {15, 25}, {5, 25}}}}};
    return drawing;
}

using Writer = void (*)(
    const Drawing&, const DrawingSettings&, std::string&, const Progress&, const CancelFlag*);

inline std::string
written(Writer write, const Drawing& drawing, const DrawingSettings& settings = {}) {
    std::string bytes;
    write(drawing, settings, bytes, {}, nullptr);
    return bytes;
}

} // namespace vera
