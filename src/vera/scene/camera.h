// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/ray.h"
#include "vera/math/vec3.h"

namespace vera {

/// PROJECTION viewpoint lower-left lower-right upper-left
/// PARALLEL direction lower-left lower-right upper-left
/// The three points are corners of the picture in space. They are not on one line, and neither is
/// the view point in their plane nor the direction parallel to it.
struct Camera {
    enum class Projection { perspective, parallel };

    Projection projection = Projection::perspective;
    Vec3 viewpoint; ///< perspective only
    Vec3 direction; ///< parallel only; any length
    Vec3 lower_left;
    Vec3 lower_right;
    Vec3 upper_left;
};

/// The ray through the point of the picture that lies x of its width from the left and y of its
/// height from the top, both from 0 to 1, with a unit direction. A perspective ray starts at the
/// view point; a parallel one sees everything along its line, and so has t_min = -infinity and
/// its origin on the image plane.
Ray view_ray(const Camera& camera, double x, double y);

} // namespace vera
