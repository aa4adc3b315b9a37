// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/camera.h"
#include "vera/scene/facets.h"
#include "vera/scene/picture_settings.h"
#include "vera/scene/scene.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/projection.h"
#include "vera/visible/visible_map.h"

namespace vera {

/// A map of what is seen, and what it was made from.
struct MapSources {
    const Scene& scene;
    const Camera& camera;
    const CameraMap& camera_map;
    const PictureSettings& picture;
    const Facets& facets;
    const DrawnFaces& faces;
    const VisibleMap& map; ///< whose sources are the faces
    double deviation = 0;  ///< how far facets may lie off what is curved, in pixels
};

} // namespace vera
