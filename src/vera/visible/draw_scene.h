// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/drawing.h"
#include "vera/scene/camera.h"
#include "vera/scene/picture_settings.h"
#include "vera/scene/scene.h"
#include "vera/visible/drawing_style.h"
#include "vera/visible/map_check.h"
#include "vera/visible/shadows.h"
#include "vera/visible/visibility_engine.h"

#include <cstddef>
#include <functional>

namespace vera {

struct DrawSettings {
    DrawingStyle style = DrawingStyle::flat;
    bool shadow_lines = false; ///< whether the borders of shadows are among the lines
    double deviation =
        0.1; ///< how far the plane facets of what is curved may lie off it, in pixels
    /// Called, where there is one, with the map before anything is painted; may throw, and tells
    /// its own progress.
    std::function<void(const PrimitiveMap& map, const Progress& progress)> check;
    VisibilityEngine engine = VisibilityEngine::cells; ///< the drawing is the same
    double color_tolerance =
        1.0 / 255; ///< how far the gradients of style shaded may be off the light, 1 for 255
    /// The drawing shows the same. What draw_scene() was given must be there as long as
    /// outlines may be made.
    FaceOutlines outlines = FaceOutlines::now;
};

struct DrawnScene {
    Drawing drawing;
    std::size_t facets = 0;
    std::size_t visible_faces = 0;
    std::size_t cut_rounds = 0;  ///< how often what passes through other things was cut
    std::size_t penetrating = 0; ///< pairs of facets that still do: 0 but in the worst tangles
    double longest_join = 0;     ///< as that of the map, in pixels; 0 with shadows
    double cut_nearness = 0; ///< what is so near the view point was left out, by the distance of
                             ///< the image plane; 0: nothing
    ShadowCounts shadows;    ///< nothing where none are drawn
    std::size_t lights_without_shadows = 0; ///< beyond the most that shadows are drawn of
};

/// A drawing of what the camera sees, every face an outline, and every shadow where the settings
/// ask for them: as exact as a grid of 2^22 steps across the picture. Throws InputError where style
/// ids has more than 2^24 - 1 primitives to tell apart, std::runtime_error where memory would not
/// suffice for the engine, and Cancelled soon after the flag is raised.
DrawnScene draw_scene(
    const Scene& scene,
    const Camera& camera,
    const PictureSettings& picture,
    const DrawSettings& settings,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// The same where the scene is not needed any more, but by the check: takes less memory, as the
/// scene may be emptied on the way.
DrawnScene draw_scene(
    Scene&& scene,
    const Camera& camera,
    const PictureSettings& picture,
    const DrawSettings& settings,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
