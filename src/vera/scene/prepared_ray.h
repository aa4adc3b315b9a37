// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/ray.h"

#include <cmath>
#include <limits>

namespace vera {

/// A ray with what the primitives ask of it, made once for each ray and system of coordinates.
///
/// Plane faces are looked at along the ray: moved so that the origin is 0, sheared so that the
/// direction becomes the axis along which it is longest. What is left of a corner is two
/// coordinates, and the question whether the ray's point (0, 0) lies in the face. A corner that two
/// faces share gets the same two numbers in both, so that no ray slips through between them
/// (Woop, Benthin and Wald 2013).
struct PreparedRay {
    Ray ray;
    /// The axes across the ray and along it, as members of Vec3: to look one up takes no branches.
    double Vec3::*x_axis = &Vec3::x;
    double Vec3::*y_axis = &Vec3::y;
    double Vec3::*z_axis = &Vec3::z;
    double shear_x = 0;
    double shear_y = 0;
    double direction_z = 1;
    double origin_size = 0; ///< the largest coordinate of the origin, without its sign

    PreparedRay() = default;

    explicit PreparedRay(const Ray& given)
        : ray(given)
        , origin_size(max_component(abs(given.origin))) {
        switch (longest_axis(given.direction)) {
        case 0:
            x_axis = &Vec3::y;
            y_axis = &Vec3::z;
            z_axis = &Vec3::x;
            break;
        case 1:
            x_axis = &Vec3::z;
            y_axis = &Vec3::x;
            z_axis = &Vec3::y;
            break;
        default:
            break;
        }
        direction_z = ray.direction.*z_axis;
        shear_x = ray.direction.*x_axis / direction_z;
        shear_y = ray.direction.*y_axis / direction_z;
    }

    /// Whether surfaces through the origin are those that the ray starts on. Those of parallel
    /// projections, which see what lies before their origin as well, do not start there.
    bool starts_at_origin() const { return ray.t_min >= 0; }

    /// How near its origin a surface passes that the ray starts on, when the coordinates that say
    /// where the surface lies are at most so large.
    double start_distance(double coordinate_size) const {
        // A coordinate difference, a normal and a product are rounded by a few units of 2^-53
        // each; 2^-48 leaves room for points that were moved onto one of two coincident surfaces.
        const double size = coordinate_size > origin_size ? coordinate_size : origin_size;
        return ray.origin_error + 0x1p-48 * size;
    }

    /// Also where t is infinite or not a number: then false.
    bool covers(double t) const {
        return t >= ray.t_min && t <= ray.t_max
            && std::abs(t) <= std::numeric_limits<double>::max();
    }
};

/// A point as the ray sees it: two coordinates across the ray, one along the axis that its
/// direction is longest on.
struct ShearedPoint {
    double x = 0;
    double y = 0;
    double z = 0;
};

inline ShearedPoint sheared(const PreparedRay& prepared, const Vec3& point) {
    const Vec3& origin = prepared.ray.origin;
    const double z = point.*prepared.z_axis - origin.*prepared.z_axis;
    return {
        (point.*prepared.x_axis - origin.*prepared.x_axis) - prepared.shear_x * z,
        (point.*prepared.y_axis - origin.*prepared.y_axis) - prepared.shear_y * z,
        z};
}

/// Twice the area of the triangle from the ray to a and b: its sign says on which side the edge
/// passes the ray. Rounding may make it 0, but never gives it the wrong sign, since each product
/// is rounded by itself and rounding keeps order.
inline double edge_function(const ShearedPoint& a, const ShearedPoint& b) {
    return a.x * b.y - a.y * b.x;
}

} // namespace vera
