// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/vec3.h"

#include <limits>

namespace vera {

/// A half line, or a part of it: the points origin + t * direction, t_min <= t <= t_max. The
/// direction need not be a unit vector: a ray that is carried into a subscene keeps its t.
struct Ray {
    Vec3 origin;
    Vec3 direction;
    double t_min = 0;
    double t_max = std::numeric_limits<double>::infinity();
    /// How far rounding may have moved the origin, along any axis: 0 for a point that was given. A
    /// surface that passes within this distance of the origin is one that the ray starts on.
    double origin_error = 0;
};

constexpr Vec3 point_at(const Ray& ray, double t) {
    return ray.origin + t * ray.direction;
}

} // namespace vera
