// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/picture_settings.h"
#include "vera/scene/scene.h"

#include <cstdint>
#include <vector>

namespace vera::reference {

/// What the reference makes of a scene.
struct ReferencePicture {
    std::vector<std::uint8_t> bytes; ///< rows from the top, three bytes a pixel
    double light_factor = 1;         ///< what EXPMES multiplied the light sources and AMBIENT by
};

/// The scene's picture by the settings, one ray through the centre of each pixel (antialiasing is
/// not done here). The scene has a camera.
ReferencePicture reference_picture(const Scene& scene, const PictureSettings& settings);

} // namespace vera::reference
