// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/drawing.h"
#include "vera/scene/camera.h"
#include "vera/scene/picture_settings.h"
#include "vera/scene/scene.h"

#include <cstddef>
#include <cstdint>

namespace vera {

enum class DrawingStyle : std::uint8_t {
    flat,   ///< each face in the colour that the light gives its middle
    shaded, ///< each face in gradients, as the light shades it
    ids,    ///< each primitive in the colour of its number, from 1 on; 0 is the background
    lines,  ///< outlines and creases alone
};

struct DrawSettings {
    DrawingStyle style = DrawingStyle::flat;
    double deviation =
        0.1; ///< how far the plane facets of what is curved may lie off it, in pixels
    double color_tolerance =
        1.0 / 255; ///< how far the gradients of style shaded may be off the light, 1 for 255
};

struct DrawnScene {
    Drawing drawing;
    std::size_t facets = 0;
    std::size_t visible_faces = 0;
    std::size_t cut_rounds = 0;  ///< how often what passes through other things was cut
    std::size_t penetrating = 0; ///< pairs of facets that still do: 0 but in the worst tangles
    double cut_nearness = 0; ///< what is so near the view point was left out, by the distance of
                             ///< the image plane; 0: nothing
};

/// A drawing of what the camera sees, every face an outline: as exact as a grid of 2^22 steps
/// across the picture. Throws InputError where style ids has more than 2^24 - 1 primitives to tell
/// apart.
DrawnScene draw_scene(
    const Scene& scene,
    const Camera& camera,
    const PictureSettings& picture,
    const DrawSettings& settings,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
