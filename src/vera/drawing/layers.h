// SPDX-License-Identifier: Apache-2.0
// What all formats of drawings have in common: what is left of the drawing after rounding, in
// layers, and the page that it stands on.
#pragma once

#include "vera/base/long_loop.h"
#include "vera/drawing/drawing_file.h"
#include "vera/drawing/seams.h"
#include "vera/drawing/snapped_path.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vera::detail {

/// A filled outline of which something is left.
struct FilledPath {
    const FilledOutline* outline = nullptr;
    std::vector<SnappedPath> rings;
    std::vector<SnappedPath> seams; ///< the lines that cover them; none when none are to
};

/// The lines of one class, of which there is one at least: see for_each_line().
struct LineLayer {
    std::string name; ///< for people: "Hidden lines"
    LineStyle style;
};

/// The drawing in the order in which it is painted: each outline and right behind it the lines that
/// cover its seams, the shared areas, then the layers of lines. Refers to the Drawing.
struct Layers {
    std::vector<FilledPath> fills; ///< without the areas, which take less room as they are
    std::vector<LineLayer> lines;
    bool is_filled = false;          ///< something is left of an outline or an area
    PassedPoints passed;             ///< of the seams of all outlines
    std::vector<FilledOutline> made; ///< of later outlines, where all are among the fills
};

/// Whether outlines that are made later are made at once, for those who write the fills one behind
/// the other, or some at a time: see later_paths().
enum class LaterOutlines : std::uint8_t { at_once, some_at_a_time };

/// Throws Cancelled.
Layers layers(
    const Drawing& drawing,
    const DrawingSettings& settings,
    const Lattice& lattice,
    LaterOutlines later,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// Outlines, those of which something is left, as filled paths, which refer to them. The points are
/// those that the seams of all outlines pass.
std::vector<FilledPath> filled_paths(
    std::span<const FilledOutline> outlines,
    const DrawingSettings& settings,
    const Lattice& lattice,
    const PassedPoints& passed,
    const CancelFlag* cancel = nullptr);

/// Some of the shared areas, those of which something is left, as filled paths.
struct AreaPaths {
    std::vector<FilledOutline> outlines;
    std::vector<FilledPath> fills; ///< refer to the outlines
};

/// Of the areas from number first up to last.
AreaPaths
area_paths(const SharedAreas& areas, const Lattice& lattice, std::size_t first, std::size_t last);

/// Calls visit(line) for each of the layer's lines of which something is left after rounding, one
/// after the other, so that no list of them takes room. Throws Cancelled.
template <typename Visit>
void for_each_line(
    const Drawing& drawing,
    const LineLayer& layer,
    const Lattice& lattice,
    const Progress& progress,
    const CancelFlag* cancel,
    const Visit& visit) {
    const LongLoop loop(drawing.strokes.size(), progress, cancel, 256);
    for (std::size_t i = 0; i < drawing.strokes.size(); ++i) {
        loop.turn(i);
        const Stroke& stroke = drawing.strokes[i];
        if (stroke.line_class != layer.style.line_class)
            continue;
        if (const std::optional<SnappedPath> line = snapped_line(stroke, lattice))
            visit(*line);
    }
}

constexpr std::size_t block_of_fills = 4096;

/// Calls visit(done, span of FilledPaths) for all outlines that are filled in their order, and
/// tells with how many it is done: so few at a time that what is made of them takes no room.
template <typename Visit>
void for_each_block_of_outlines(const Layers& layers, const Visit& visit) {
    constexpr std::size_t block = block_of_fills;
    const std::size_t fills = layers.fills.size();
    for (std::size_t first = 0; first < fills; first += block)
        visit(first, std::span(layers.fills).subspan(first, std::min(block, fills - first)));
}

/// The same with the areas behind them.
template <typename Visit>
void for_each_block_of_fills(
    const Drawing& drawing, const Layers& layers, const Lattice& lattice, const Visit& visit) {
    constexpr std::size_t block = block_of_fills;
    for_each_block_of_outlines(layers, visit);
    const std::size_t fills = layers.fills.size();
    const std::size_t areas = drawing.areas.count();
    for (std::size_t first = 0; first < areas; first += block) {
        const AreaPaths paths =
            area_paths(drawing.areas, lattice, first, std::min(areas, first + block));
        visit(fills + first, std::span(paths.fills));
    }
}

/// What people call the layer of the outlines.
inline constexpr char fills_name[] = "Fills";

/// The page's size in points, of which 72 are an inch.
struct PageSize {
    double width = 0;
    double height = 0;
};

PageSize page_size(const Drawing& drawing, const DrawingSettings& settings);

} // namespace vera::detail
