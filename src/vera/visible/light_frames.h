// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/box3.h"
#include "vera/math/vec3.h"
#include "vera/scene/camera.h"

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace vera {

/// A part of the border of what is seen of a face.
struct SeenSegment {
    std::array<Vec3, 2> ends;
    std::array<double, 2> pixels = {}; ///< how large one is there, in the scene's units
};

/// Calls what it is given for each part of the borders, the same each time: kept, they would be the
/// largest thing of a drawing.
using SeenSegments = std::function<void(const std::function<void(const SeenSegment&)>& visit)>;

/// Where a light looks.
struct LightFrame {
    Camera camera;       ///< in coordinates about the light
    double farthest = 0; ///< nothing behind that, along the view, is asked for
    /// Of its grid, in the scene's units, where it is too coarse and there is no finer one; else 0.
    double coarse_step = 0;
};

/// Of each light, at these places, the frames in which it sees all of the box, in coordinates about
/// the light: one where the box lies before it, else the six sides of a cube. Where a step of a
/// frame's grid is more than 1/64 of a pixel at something that is seen, a finer frame of all such
/// places lies over it, and so on: a floor to the horizon does not take the digits from what stands
/// on it. Where such places fill the frame, its quarters. What is seen is gone through once for
/// each step towards finer frames, for all lights together.
std::vector<std::vector<LightFrame>>
light_frames(std::span<const Vec3> positions, const Box3& box, const SeenSegments& seen);

} // namespace vera
