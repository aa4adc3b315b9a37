// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/hit.h"
#include "vera/scene/prepared_ray.h"
#include "vera/scene/primitives.h"

#include <cmath>

namespace vera {

/// Calls sink(t) for both crossings of the ray with the sphere that lie in the ray's range, the
/// smaller first; twice with the same t where the ray touches it. A ray that starts on the sphere,
/// by the caller's word or to within rounding, has only the other crossing.
template <typename Sink>
inline void for_each_sphere_crossing(
    const PreparedRay& prepared, const Sphere& sphere, bool starts_here, const Sink& sink) {
    const Vec3 direction = prepared.ray.direction;
    const double speed_squared = dot(direction, direction);
    const Vec3 to_center = sphere.center - prepared.ray.origin;
    const double t_closest = dot(to_center, direction) / speed_squared;
    const auto sink_other = [&] {
        // One root of the quadratic equation is 0: what is left of it is linear.
        if (t_closest > 0 && prepared.covers(2 * t_closest))
            sink(2 * t_closest);
    };
    if (starts_here)
        return sink_other();

    // The distance from the center to the ray, squared, taken as a length and not as
    // |to_center|^2 - t_closest^2, which cancels when the sphere is small and far away.
    const Vec3 offset = to_center - t_closest * direction;
    const double half_chord_squared = sphere.radius * sphere.radius - dot(offset, offset);
    if (!(half_chord_squared >= 0))
        return;

    if (prepared.starts_at_origin()) {
        const double size =
            max_component(max(abs(sphere.center), {sphere.radius, sphere.radius, sphere.radius}));
        // | |to_center| - radius | times the sum of the two.
        const double from_surface =
            std::abs(dot(to_center, to_center) - sphere.radius * sphere.radius);
        // A point off by so much along each axis is off by sqrt(3) times that.
        if (from_surface <= 2 * sphere.radius * 1.75 * prepared.start_distance(size))
            return sink_other();
    }
    const double half_chord = std::sqrt(half_chord_squared / speed_squared);
    for (const double t : {t_closest - half_chord, t_closest + half_chord})
        if (prepared.covers(t))
            sink(t);
}

} // namespace vera
