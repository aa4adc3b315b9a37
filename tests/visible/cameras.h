// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/camera.h"

#include <array>
#include <cstddef>

namespace vera::testing {

/// Cameras all round a scene about the origin, some of parallel rays, some within it.
inline Camera camera_number(int number) {
    const Vec3 to = normalized(std::array<Vec3, 5>{
        {{1, 0.3, 0.2},
         {-0.2, 1, 0.4},
         {0.3, -0.2, 1},
         {-1, -0.7, 0.1},
         {0, 0, 1}}}[static_cast<std::size_t>(number) % 5]);
    const Vec3 across = normalized(cross(to, {0.1, 0.2, 1}));
    const Vec3 up = cross(across, to);
    const double distance = number % 3 == 0 ? 1 : 8;
    Camera camera;
    camera.projection =
        number % 4 == 3 ? Camera::Projection::parallel : Camera::Projection::perspective;
    camera.viewpoint = -distance * to;
    camera.direction = to;
    const double half = number % 4 == 3 ? 3 : 0.5 * distance;
    camera.lower_left = -half * across - half * up;
    camera.lower_right = half * across - half * up;
    camera.upper_left = -half * across + half * up;
    return camera;
}

} // namespace vera::testing
