// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/camera.h"
#include "vera/scene/facets.h"
#include "vera/scene/picture_settings.h"
#include "vera/scene/scene.h"
#include "vera/visible/drawing_style.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/region_paint.h"
#include "vera/visible/visible_map.h"

namespace vera {

/// What areas are painted from.
struct FillSources {
    const Scene& scene;
    const Camera& camera;
    const PictureSettings& picture;
    const Facets& facets;
    const DrawnFaces& faces;
    const VisibleMap& map; ///< whose sources are the faces
    DrawingStyle style = DrawingStyle::flat;
    PaintTolerance tolerance; ///< of gradients
};

} // namespace vera
