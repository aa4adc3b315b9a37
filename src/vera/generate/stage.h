// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/picture_settings.h"
#include "vera/scene/scene.h"

#include <string>

namespace vera {

/// What is set up round a model so that its picture is worth looking at.
struct Stage {
    enum class Ground {
        studio, ///< a pale floor that bends up into a wall
        meadow, ///< grass below a sky
    };

    Ground ground = Ground::studio;
    double azimuth_degrees = 30;      ///< of the viewer, from the z axis towards x
    double elevation_degrees = 20;    ///< of the viewer above the horizon
    double margin = 0.1;              ///< left free round the model, as part of the picture
    Color color = {0.72, 0.70, 0.66}; ///< DRF of what has no material
    double mirror = 0;                ///< RAB of it
};

/// The model as a subscene of that name, in a material called shape where it has none, with ground,
/// lights and a camera. It looks well with no control file, and better with stage_settings().
/// Throws InputError for a model without surfaces.
Scene staged(Scene model, const std::string& name, const Stage& stage);

/// The settings for the picture of a staged scene.
PictureSettings stage_settings();

/// The same as the text of a control file.
std::string stage_control_text();

} // namespace vera
