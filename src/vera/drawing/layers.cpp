// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/layers.h"

#include "vera/base/check.h"
#include "vera/drawing/seams.h"

#include <cmath>
#include <cstddef>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace vera::detail {

namespace {

LineStyle style_of(const std::string& line_class, const DrawingSettings& settings) {
    for (const LineStyle& style : settings.line_styles)
        if (style.line_class == line_class)
            return style;
    return {.line_class = line_class};
}

std::string layer_name(const std::string& line_class) {
    if (line_class.empty())
        return "Lines";
    std::string name = line_class + " lines";
    if (name.front() >= 'a' && name.front() <= 'z')
        name.front() = static_cast<char>(name.front() - 'a' + 'A');
    return name;
}

} // namespace

Layers layers(const Drawing& drawing, const DrawingSettings& settings, const Lattice& lattice) {
    Layers result;
    PassedPoints passed;
    for (const FilledOutline& fill : drawing.fills) {
        FilledPath path = {&fill, snapped_rings(fill, lattice), {}};
        if (path.rings.empty())
            continue;
        if (settings.cover_seams)
            path.seams = joined_seams(fill, lattice);
        passed.add(path.seams);
        result.fills.push_back(std::move(path));
    }
    const double seam_width = settings.seam_width * lattice.units_per_pixel();
    VERA_CHECK(seam_width >= 0 && std::isfinite(seam_width));
    for (FilledPath& path : result.fills)
        draw_ends_back(path.seams, path.rings, passed, seam_width);

    std::unordered_map<std::string_view, std::size_t> layer_of;
    for (const Stroke& stroke : drawing.strokes) {
        std::optional<SnappedPath> line = snapped_line(stroke, lattice);
        if (!line)
            continue;
        const auto [layer, is_new] = layer_of.try_emplace(stroke.line_class, result.lines.size());
        if (is_new)
            result.lines.push_back(
                {layer_name(stroke.line_class), style_of(stroke.line_class, settings), {}});
        result.lines[layer->second].lines.push_back(std::move(*line));
    }
    return result;
}

PageSize page_size(const Drawing& drawing, const DrawingSettings& settings) {
    VERA_CHECK(drawing.width > 0 && std::isfinite(drawing.width));
    VERA_CHECK(drawing.height > 0 && std::isfinite(drawing.height));
    VERA_CHECK(
        settings.page_width_millimeters >= 0 && std::isfinite(settings.page_width_millimeters));
    const double points_per_pixel = settings.page_width_millimeters > 0
        ? settings.page_width_millimeters / 25.4 * 72 / drawing.width
        : 72.0 / 96;
    return {points_per_pixel * drawing.width, points_per_pixel * drawing.height};
}

} // namespace vera::detail
