// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/camera.h"

namespace vera {

ViewRays::ViewRays(const Camera& camera)
    : projection(camera.projection)
    , across(camera.lower_right - camera.lower_left)
    , up(camera.upper_left - camera.lower_left) {
    if (projection == Camera::Projection::parallel) {
        corner = camera.lower_left;
        origin_or_direction = normalized(camera.direction);
    } else {
        corner = camera.lower_left - camera.viewpoint;
        origin_or_direction = camera.viewpoint;
    }
}

Ray view_ray(const Camera& camera, double x, double y) {
    return ViewRays(camera).ray(x, y);
}

} // namespace vera
