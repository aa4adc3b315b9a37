// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/ray.h"
#include "vera/scene/geometry.h"
#include "vera/scene/hit.h"

#include <cmath>

namespace vera {

/// Hits of one ray whose t differ by no more than this, at t, are hits of surfaces that coincide:
/// the one that stands first in the text is in front. It follows from the rounding of coordinates
/// of the size of those where the ray passes, and scales with the scene.
inline double coincidence_tolerance(const Ray& ray, double t) {
    // Rounding moves t by a few units of 2^-53 of the coordinates over the cosine of incidence;
    // 2^-41 allows for cosines down to 1/500.
    const double direction_size = max_component(abs(ray.direction));
    const double origin_size = max_component(abs(ray.origin)) + ray.origin_error;
    return direction_size > 0 ? 0x1p-41 * (origin_size / direction_size + std::abs(t)) : 0;
}

} // namespace vera
