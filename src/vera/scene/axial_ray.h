// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/prepared_ray.h"
#include "vera/scene/primitives.h"

#include <cmath>

namespace vera {

/// A ray as a rotational shape sees it: with s = t - t_reference, its height along the axis is
/// height + rise * s, and the square of its distance from the axis is a s^2 + 2 b s + c. In the
/// half plane of r and h that is one branch of a hyperbola about the h axis.
struct AxialRay {
    double t_reference = 0;
    Vec3 from_axis; ///< at s = 0
    Vec3 across;    ///< the direction without its part along the axis
    double height = 0;
    double rise = 0;
    double a = 0;
    double b = 0; ///< 0 when the ray is flat
    double c = 0;
    /// Whether the ray runs rather across the axis than along it. Then s = 0 is its point nearest
    /// to the axis; else it is its point at the height where the contour starts. So s stays small
    /// where the shape is, and no digits are lost.
    bool flat = false;

    AxialRay(const PreparedRay& prepared, const RotationalShape& shape) {
        const Vec3 from_base = prepared.ray.origin - shape.base;
        height = dot(from_base, shape.axis);
        from_axis = from_base - height * shape.axis;
        rise = dot(prepared.ray.direction, shape.axis);
        across = prepared.ray.direction - rise * shape.axis;
        a = dot(across, across);
        flat = a > rise * rise;
        t_reference = flat ? -dot(from_axis, across) / a : (shape.start.h - height) / rise;
        from_axis = from_axis + t_reference * across;
        height = flat ? height + t_reference * rise : shape.start.h;
        b = flat ? 0 : dot(from_axis, across);
        c = dot(from_axis, from_axis);
    }

    double height_at(double s) const { return height + s * rise; }

    /// As the square of a length: the polynomial would cancel where the ray passes the axis.
    double radius_squared_at(double s) const {
        const Vec3 at = from_axis + s * across;
        return dot(at, at);
    }
};

} // namespace vera
