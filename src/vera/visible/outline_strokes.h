// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/scene/facets.h"
#include "vera/scene/picture_settings.h"
#include "vera/scene/scene.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/visible_map.h"

namespace vera {

/// What lines are drawn from.
struct StrokeSources {
    const Scene& scene;
    const Facets& facets;
    const DrawnFaces& faces;
    const ScreenScene& screen;
    const VisiblePieces& pieces;
    const VisibleMap& map;
};

/// Adds the lines that part what is seen: silhouettes, where one of two surfaces ends before the
/// other or before nothing, and creases, where two meet at an angle. The frame is neither. Pieces
/// that go on in each other become one stroke.
void add_strokes(const StrokeSources& sources, const PictureSettings& picture, Drawing& drawing);

} // namespace vera
