// SPDX-License-Identifier: Apache-2.0
// What all formats of drawings have in common: what is left of the drawing after rounding, in
// layers, and the page that it stands on.
#pragma once

#include "vera/drawing/drawing_file.h"
#include "vera/drawing/snapped_path.h"

#include <string>
#include <vector>

namespace vera::detail {

/// A filled outline of which something is left.
struct FilledPath {
    const FilledOutline* outline = nullptr;
    std::vector<SnappedPath> rings;
    std::vector<SnappedPath> seams; ///< the lines that cover them; none when none are to
};

/// The lines of one class.
struct LineLayer {
    std::string name; ///< for people: "Hidden lines"
    LineStyle style;
    std::vector<SnappedPath> lines;
};

/// The drawing in the order in which it is painted: each outline and right behind it the lines that
/// cover its seams, then the layers of lines. Refers to the Drawing.
struct Layers {
    std::vector<FilledPath> fills;
    std::vector<LineLayer> lines;
};

/// Throws Cancelled.
Layers layers(
    const Drawing& drawing,
    const DrawingSettings& settings,
    const Lattice& lattice,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// What people call the layer of the outlines.
inline constexpr char fills_name[] = "Fills";

/// The page's size in points, of which 72 are an inch.
struct PageSize {
    double width = 0;
    double height = 0;
};

PageSize page_size(const Drawing& drawing, const DrawingSettings& settings);

} // namespace vera::detail
