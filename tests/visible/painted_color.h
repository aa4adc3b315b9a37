// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/math/color.h"
#include "vera/visible/half_plane.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace vera::testing {

/// How often the rings go round the point, added up.
template <typename Ring>
int turns_about(const std::vector<Ring>& rings, DrawingPoint point) {
    int turns = 0;
    for (const Ring& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const DrawingPoint a = ring[i];
            const DrawingPoint b = ring[i + 1 == ring.size() ? 0 : i + 1];
            if ((a.y > point.y) == (b.y > point.y))
                continue;
            if (a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x) > point.x)
                turns += b.y > a.y ? 1 : -1;
        }
    return turns;
}

/// Twice the area, as shoelaces give it.
template <typename Ring>
double doubled_area(const std::vector<Ring>& rings) {
    double area = 0;
    for (const Ring& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const DrawingPoint a = ring[i];
            const DrawingPoint b = ring[i + 1 == ring.size() ? 0 : i + 1];
            area += a.x * b.y - a.y * b.x;
        }
    return area;
}

/// The rings of the outline, with chords of arcs by a degree each.
std::vector<PointChain> flattened_rings(const FilledOutline& outline);

/// What the outlines show at the point, 1 for 255: the last one that covers it, by the definition
/// of SVG. Nothing where none does.
std::optional<Color> painted_color(std::span<const FilledOutline> fills, DrawingPoint point);

} // namespace vera::testing
