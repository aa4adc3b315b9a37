// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/ray.h"
#include "vera/math/vec3.h"

#include <limits>

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

/// What the rays of a camera have in common, worked out.
struct ViewRays {
    explicit ViewRays(const Camera& camera);

    /// See view_ray.
    Ray ray(double x, double y) const { return ray(place_across(x), place_up(y)); }

    /// The same of what place_across(x) and place_up(y) return, which serve a whole column and row.
    Ray ray(Vec3 place_across, Vec3 place_up) const {
        const Vec3 place = place_across + place_up;
        Ray ray;
        if (projection == Camera::Projection::parallel) {
            ray.origin = place;
            ray.direction = origin_or_direction;
            ray.t_min = -std::numeric_limits<double>::infinity();
        } else {
            ray.origin = origin_or_direction;
            ray.direction = normalized(place);
        }
        return ray;
    }

    Vec3 place_across(double x) const { return corner + x * across; }

    Vec3 place_up(double y) const { return (1 - y) * up; }

    Camera::Projection projection;
    Vec3 across;              ///< the picture's lower side, from the left
    Vec3 up;                  ///< its left side, from below
    Vec3 corner;              ///< the lower left one, of perspective as seen from the view point
    Vec3 origin_or_direction; ///< of all rays: the view point, or the direction, unit
};

/// The ray through the point of the picture that lies x of its width from the left and y of its
/// height from the top, both from 0 to 1, with a unit direction. A perspective ray starts at the
/// view point; a parallel one sees everything along its line, and so has t_min = -infinity and
/// its origin on the image plane.
Ray view_ray(const Camera& camera, double x, double y);

} // namespace vera
