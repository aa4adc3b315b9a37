// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/layers.h"

#include "vera/base/check.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
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

/// Of the classes of which a line is left after rounding: the first one most often.
std::vector<LineLayer> line_layers(
    std::span<const Stroke> strokes, const DrawingSettings& settings, const Lattice& lattice) {
    std::array<bool, line_class_names.size()> has_lines = {};
    for (const Stroke& stroke : strokes)
        if (bool& has_one = has_lines[static_cast<std::size_t>(stroke.line_class)]; !has_one)
            has_one = snapped_line(stroke, lattice).has_value();
    std::vector<LineLayer> layers;
    for (std::size_t i = 0; i < has_lines.size(); ++i)
        if (const auto line_class = static_cast<LineClass>(i); has_lines[i])
            layers.push_back({layer_name(line_class), style_of(line_class, settings)});
    return layers;
}

/// Seams of which nothing was drawn back yet.
FilledPath
snapped_fill(const FilledOutline& fill, const DrawingSettings& settings, const Lattice& lattice) {
    FilledPath path = {&fill, snapped_rings(fill, lattice), {}};
    if (settings.cover_seams && !path.rings.empty())
        path.seams = joined_seams(fill, lattice);
    return path;
}

/// In units of the lattice.
double seam_width(const DrawingSettings& settings, const Lattice& lattice) {
    const double width = settings.seam_width * lattice.units_per_pixel();
    VERA_CHECK(width >= 0 && std::isfinite(width));
    return width;
}

} // namespace

Layers layers(
    const Drawing& drawing,
    const DrawingSettings& settings,
    const Lattice& lattice,
    LaterOutlines later,
    const Progress& progress,
    const CancelFlag* cancel) {
    StageProgress stages(progress, 2);
    Layers result;
    const LaterFills& others = drawing.later_fills;
    for (std::size_t i = 0; later == LaterOutlines::at_once && i < others.blocks; ++i)
        std::ranges::move(others.block(i, cancel), std::back_inserter(result.made));
    const std::size_t given = drawing.fills.size();
    result.fills.resize(given + result.made.size());
    long_parallel_loop(result.fills.size(), stages.next(1), cancel, 256, [&](std::size_t i) {
        result.fills[i] =
            snapped_fill(i < given ? drawing.fills[i] : result.made[i - given], settings, lattice);
    });
    std::erase_if(result.fills, [](const FilledPath& path) { return path.rings.empty(); });
    result.is_filled = !result.fills.empty();
    for (const FilledPath& path : result.fills)
        result.passed.add(path.seams);
    const bool has_others = later == LaterOutlines::some_at_a_time && settings.cover_seams;
    for (std::size_t i = 0; has_others && i < others.blocks; ++i)
        for (const FilledOutline& outline : others.with_seams(i, cancel))
            result.passed.add(snapped_fill(outline, settings, lattice).seams);
    const double width = seam_width(settings, lattice);
    long_parallel_loop(result.fills.size(), stages.next(1), cancel, 256, [&](std::size_t i) {
        draw_ends_back(result.fills[i].seams, result.fills[i].rings, result.passed, width);
    });

    // Of the first area most often: it takes no time.
    for (std::size_t i = 0; !result.is_filled && i < drawing.areas.count(); ++i)
        result.is_filled = !snapped_rings(outline_of(drawing.areas, i), lattice).empty();
    result.lines = line_layers(drawing.strokes, settings, lattice);
    return result;
}

std::vector<FilledPath> filled_paths(
    std::span<const FilledOutline> outlines,
    const DrawingSettings& settings,
    const Lattice& lattice,
    const PassedPoints& passed,
    const CancelFlag* cancel) {
    std::vector<FilledPath> paths(outlines.size());
    const double width = seam_width(settings, lattice);
    long_parallel_loop(outlines.size(), {}, cancel, 64, [&](std::size_t i) {
        paths[i] = snapped_fill(outlines[i], settings, lattice);
        draw_ends_back(paths[i].seams, paths[i].rings, passed, width);
    });
    std::erase_if(paths, [](const FilledPath& path) { return path.rings.empty(); });
    return paths;
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
