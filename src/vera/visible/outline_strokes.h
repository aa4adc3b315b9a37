// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/drawing.h"
#include "vera/scene/facets.h"
#include "vera/scene/picture_settings.h"
#include "vera/scene/scene.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/projection.h"
#include "vera/visible/visible_map.h"

#include <cstdint>

namespace vera {

/// What lines are drawn from.
struct StrokeSources {
    const Scene& scene;
    const Camera& camera;
    const CameraMap& camera_map;
    const PictureSettings& picture;
    const Facets& facets;
    const DrawnFaces& faces;
    const ScreenScene& screen;
    const VisiblePieces& pieces;
    const VisibleMap& map;
    double deviation = 0;               ///< how far facets may lie off what is curved, in pixels
    const ScreenScene* uncut = nullptr; ///< for hidden lines: before what penetrates was cut
};

/// Lines that not every drawing is to have.
struct ExtraLines {
    bool hidden = false;  ///< what is not seen of silhouettes, creases and intersections
    bool shadows = false; ///< where the screen's shadows end
};

/// Adds the lines that part what is seen, by class, and the extra ones. The frame is no line. What
/// goes on in each other becomes one stroke, and what lies on an ellipse of a curved primitive an
/// arc of it. Throws Cancelled.
void add_strokes(
    const StrokeSources& sources,
    const ExtraLines& extra,
    const Progress& progress,
    const CancelFlag* cancel,
    Drawing& drawing);

} // namespace vera
