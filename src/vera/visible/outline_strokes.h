// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/drawing.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/map_sources.h"
#include "vera/visible/screen_scene.h"

namespace vera {

/// What lines are drawn from; what is theirs alone is forgotten on the way.
struct StrokeSources : MapSources {
    ScreenScene screen;
    VisiblePieces pieces; ///< whose points are the map's vertices, and not there
    ScreenScene uncut;    ///< for hidden lines: before what penetrates was cut
};

/// Lines that not every drawing is to have.
struct ExtraLines {
    bool hidden = false;  ///< what is not seen of silhouettes, creases and intersections
    bool shadows = false; ///< where shadows end
};

/// Adds the lines that part what is seen, by class, and the extra ones. The frame is no line. What
/// goes on in each other becomes one stroke, and what lies on an ellipse of a curved primitive an
/// arc of it. Throws Cancelled.
void add_strokes(
    StrokeSources sources,
    const ExtraLines& extra,
    const Progress& progress,
    const CancelFlag* cancel,
    Drawing& drawing);

} // namespace vera
