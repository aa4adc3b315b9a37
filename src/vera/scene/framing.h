// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/scene.h"

#include <cstdint>
#include <vector>

namespace vera {

/// The picture that a scene is to be framed for.
struct FrameSettings {
    std::uint32_t width = 512; ///< pixels
    std::uint32_t height = 512;
    double margin = 0.05;    ///< left free on each side: part of the width, and of the height
    double pixel_aspect = 1; ///< width of a pixel by its height
};

/// A perspective view from the front, right and above (y is up), from where the scene fills the
/// picture: its silhouette touches two opposite margins and lies in the middle between the other
/// two. It is the silhouette of the primitives themselves, not of boxes. Throws InputError for an
/// empty scene.
Camera framed_camera(const Scene& scene, const FrameSettings& frame);

/// The camera with its view point (or direction) and its image plane kept, and the part of that
/// plane chosen that the scene fills, as in framed_camera. Throws InputError when the scene is
/// empty or does not lie wholly in front of the view point.
Camera reframed_camera(const Scene& scene, const Camera& camera, const FrameSettings& frame);

/// For scenes without lights: one white light that does not fall off with distance, to the upper
/// left of the viewer.
std::vector<PointLight> default_lights(const Scene& scene, const Camera& camera);

} // namespace vera
