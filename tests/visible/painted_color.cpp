// SPDX-License-Identifier: Apache-2.0
#include "visible/painted_color.h"

#include "vera/drawing/elliptic_arc.h"
#include "vera/drawing/gradient.h"

#include <cmath>
#include <cstddef>

namespace vera::testing {

std::vector<PointChain> flattened_rings(const FilledOutline& outline) {
    std::vector<PointChain> rings;
    for (std::size_t i = 0; i < outline.rings.size(); ++i) {
        PointChain& ring = rings.emplace_back();
        const std::vector<DrawingArc> none;
        const std::vector<DrawingArc>& arcs = i < outline.arcs.size() ? outline.arcs[i] : none;
        auto arc = arcs.begin();
        for (std::size_t j = 0; j < outline.rings[i].size(); ++j) {
            ring.push_back(outline.rings[i][j]);
            if (arc == arcs.end() || arc->segment != j)
                continue;
            const double sweep = arc->end_degrees - arc->begin_degrees;
            const double parts = std::ceil(std::abs(sweep));
            for (double part = 1; part < parts; ++part)
                ring.push_back(point_at(arc->ellipse, arc->begin_degrees + part / parts * sweep));
            ++arc;
        }
    }
    return rings;
}

std::optional<Color> painted_color(std::span<const FilledOutline> fills, DrawingPoint point) {
    for (std::size_t i = fills.size(); i-- > 0;) {
        const FilledOutline& fill = fills[i];
        if (turns_about(flattened_rings(fill), point) == 0)
            continue;
        if (fill.gradient)
            return color_at(*fill.gradient, point);
        return Color{fill.color.r / 255.0, fill.color.g / 255.0, fill.color.b / 255.0};
    }
    return std::nullopt;
}

} // namespace vera::testing
