// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/scene/camera.h"
#include "vera/scene/facets.h"
#include "vera/scene/scene.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/projection.h"
#include "vera/visible/screen_scene.h"

#include <cstddef>

namespace vera {

/// A scene of which shadows are drawn, as a camera sees it.
struct ShadowedScene {
    const Scene& scene;
    const Facets& facets;
    const DrawnFaces& faces; ///< plane ones, FaceUnit::plane
    const Camera& camera;
    const CameraMap& map;
    double width = 1; ///< of the picture, in pixels
    double height = 1;
    const VisiblePieces& seen; ///< of the screen without shadows: these fall on what is seen alone
};

/// How much there was to do.
struct ShadowCounts {
    std::size_t partly_lit = 0; ///< pairs of a light and a face of which it reaches a part
    std::size_t shadows = 0;    ///< triangles that were added
    double light_step = 0;      ///< what is smaller than that, in the scene's units, may throw no
                                ///< shadow; 0: nothing that is larger than 1/64 of a pixel
    double cut_nearness = 0; ///< what is so near a light, in the scene's units, throws no shadow;
                             ///< 0: everything does
};

/// Adds the shadows that the faces throw on each other to the screen, whose sources are the faces:
/// what a light sees of the scene tells which faces it reaches wholly, partly and not at all (3.4;
/// Atherton, Weiler and Greenberg, Polygon shadow generation, 1978). Where it is partly, the
/// shadows are those of the facets that the light sees before the face, carried to its plane by one
/// projection from corner to grid, so that a corner of a shadow is as exact as one of the scene.
/// What lets light through throws none. Takes the scene's first most_lights_of_a_set lights.
ShadowCounts add_shadows(
    const ShadowedScene& shadowed,
    ScreenScene& screen,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
