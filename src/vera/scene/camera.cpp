// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/camera.h"

#include <limits>

namespace vera {

Ray view_ray(const Camera& camera, double x, double y) {
    const Vec3 across = x * (camera.lower_right - camera.lower_left);
    const Vec3 up = (1 - y) * (camera.upper_left - camera.lower_left);
    Ray ray;
    if (camera.projection == Camera::Projection::parallel) {
        ray.origin = camera.lower_left + across + up;
        ray.direction = normalized(camera.direction);
        ray.t_min = -std::numeric_limits<double>::infinity();
    } else {
        ray.origin = camera.viewpoint;
        ray.direction = normalized((camera.lower_left - camera.viewpoint) + across + up);
    }
    return ray;
}

} // namespace vera
