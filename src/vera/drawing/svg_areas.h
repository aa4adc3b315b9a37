// SPDX-License-Identifier: Apache-2.0
// Areas of a drawing as elements of an SVG, without the outlines in between that areas of their own
// would be.
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/drawing_file.h"
#include "vera/drawing/snapped_path.h"

#include <cstddef>
#include <string>
#include <vector>

namespace vera::detail {

/// "#rgb" where that says it, else "#rrggbb".
std::string css_color(DrawingColor color);

/// A path for each of the areas from number first to before last of which something is left after
/// rounding, as outline_of() them would be written: in parts, one behind the other.
std::vector<std::string>
svg_areas(const SharedAreas& areas, const Lattice& lattice, std::size_t first, std::size_t last);

/// As write_svg(), into a file, part by part; into a pipe all at the end, in parts as well. The
/// caller commits.
void write_svg_file(
    const Drawing& drawing,
    const DrawingSettings& settings,
    OutputFile& file,
    const Progress& progress,
    const CancelFlag* cancel);

} // namespace vera::detail
