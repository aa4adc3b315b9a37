// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/drawing.h"
#include "vera/scene/camera.h"
#include "vera/scene/facets.h"
#include "vera/scene/picture_settings.h"
#include "vera/scene/scene.h"
#include "vera/visible/region_light.h"
#include "vera/visible/region_paint.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// An outline of one face, and what its light depends on.
struct LitOutline {
    PaintedRegion region;
    std::uint32_t facet = 0; ///< of the face
    LightSet lights = all_lights;
};

/// What shades a drawing.
struct ShadedScene {
    const Scene& scene;
    const Camera& camera;
    const PictureSettings& picture;
    const Facets& facets;
    PaintTolerance tolerance;
    std::span<const DrawingEllipse> curves = {}; ///< of the outlines' sides
    Progress progress = {};
    const CancelFlag* cancel = nullptr;
};

/// The outlines, in their order, each in one colour or gradient, or cut into parts that are; see
/// painted(). Throws Cancelled.
std::vector<FilledOutline>
shaded_outlines(std::vector<LitOutline> outlines, const ShadedScene& shaded);

/// The firmament behind all that is drawn.
struct DrawnFirmament {
    DrawingColor background;
    std::vector<FilledOutline> sky; ///< where it is not of the background's colour
};

DrawnFirmament drawn_firmament(
    const Camera& camera,
    const PictureSettings& picture,
    const PaintTolerance& tolerance,
    const CancelFlag* cancel = nullptr);

} // namespace vera
