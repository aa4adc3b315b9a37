// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/layers.h"

#include "vera/base/check.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/drawing/seams.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

namespace vera::detail {

namespace {

LineStyle style_of(LineClass line_class, const DrawingSettings& settings) {
    for (const LineStyle& style : settings.line_styles)
        if (style.line_class == line_class)
            return style;
    return {.line_class = line_class};
}

std::string layer_name(LineClass line_class) {
    std::string name(name_of(line_class));
    name.front() = static_cast<char>(name.front() - 'a' + 'A');
    return name + " lines";
}

std::vector<LineLayer> line_layers(
    std::span<const Stroke> strokes,
    const DrawingSettings& settings,
    const Lattice& lattice,
    const Progress& progress,
    const CancelFlag* cancel) {
    std::array<std::vector<SnappedPath>, line_class_names.size()> of_class;
    const LongLoop loop(strokes.size(), progress, cancel);
    for (std::size_t i = 0; i < strokes.size(); ++i) {
        loop.turn(i);
        if (std::optional<SnappedPath> line = snapped_line(strokes[i], lattice))
            of_class[static_cast<std::size_t>(strokes[i].line_class)].push_back(std::move(*line));
    }
    std::vector<LineLayer> layers;
    for (std::size_t i = 0; i < of_class.size(); ++i)
        if (const auto line_class = static_cast<LineClass>(i); !of_class[i].empty())
            layers.push_back(
                {layer_name(line_class), style_of(line_class, settings), std::move(of_class[i])});
    return layers;
}

} // namespace

Layers layers(
    const Drawing& drawing,
    const DrawingSettings& settings,
    const Lattice& lattice,
    const Progress& progress,
    const CancelFlag* cancel) {
    StageProgress stages(progress, 3);
    Layers result;
    result.fills.resize(drawing.fills.size());
    long_parallel_loop(drawing.fills.size(), stages.next(1), cancel, 256, [&](std::size_t i) {
        const FilledOutline& fill = drawing.fills[i];
        result.fills[i] = {&fill, snapped_rings(fill, lattice), {}};
        if (settings.cover_seams && !result.fills[i].rings.empty())
            result.fills[i].seams = joined_seams(fill, lattice);
    });
    std::erase_if(result.fills, [](const FilledPath& path) { return path.rings.empty(); });
    result.is_filled = !result.fills.empty();
    PassedPoints passed;
    for (const FilledPath& path : result.fills)
        passed.add(path.seams);
    const double seam_width = settings.seam_width * lattice.units_per_pixel();
    VERA_CHECK(seam_width >= 0 && std::isfinite(seam_width));
    const LongLoop seams(result.fills.size(), stages.next(1), cancel, 256);
    for (std::size_t i = 0; i < result.fills.size(); ++i) {
        seams.turn(i);
        draw_ends_back(result.fills[i].seams, result.fills[i].rings, passed, seam_width);
    }

    // Of the first area most often: it takes no time.
    for (std::size_t i = 0; !result.is_filled && i < drawing.areas.count(); ++i)
        result.is_filled = !snapped_rings(outline_of(drawing.areas, i), lattice).empty();
    result.lines = line_layers(drawing.strokes, settings, lattice, stages.next(1), cancel);
    return result;
}

AreaPaths
area_paths(const SharedAreas& areas, const Lattice& lattice, std::size_t first, std::size_t last) {
    AreaPaths paths;
    paths.outlines.resize(last - first);
    paths.fills.resize(last - first);
    parallel_ranges(last - first, 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            paths.outlines[i] = outline_of(areas, first + i);
            paths.fills[i] = {&paths.outlines[i], snapped_rings(paths.outlines[i], lattice), {}};
        }
    });
    std::erase_if(paths.fills, [](const FilledPath& path) { return path.rings.empty(); });
    return paths;
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
