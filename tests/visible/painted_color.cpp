// SPDX-License-Identifier: Apache-2.0
#include "visible/painted_color.h"

#include "vera/drawing/gradient.h"

#include <cstddef>

namespace vera::testing {

int turns_about(const std::vector<PointChain>& rings, DrawingPoint point) {
    int turns = 0;
    for (const PointChain& ring : rings)
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

double doubled_area(const std::vector<PointChain>& rings) {
    double area = 0;
    for (const PointChain& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const DrawingPoint a = ring[i];
            const DrawingPoint b = ring[i + 1 == ring.size() ? 0 : i + 1];
            area += a.x * b.y - a.y * b.x;
        }
    return area;
}

std::optional<Color> painted_color(std::span<const FilledOutline> fills, DrawingPoint point) {
    for (std::size_t i = fills.size(); i-- > 0;) {
        const FilledOutline& fill = fills[i];
        if (turns_about(fill.rings, point) == 0)
            continue;
        if (fill.gradient)
            return color_at(*fill.gradient, point);
        return Color{fill.color.r / 255.0, fill.color.g / 255.0, fill.color.b / 255.0};
    }
    return std::nullopt;
}

} // namespace vera::testing
