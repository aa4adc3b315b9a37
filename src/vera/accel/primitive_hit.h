// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/math/ray.h"
#include "vera/scene/hit.h"
#include "vera/scene/scene.h"

#include <cstdint>

namespace vera {

/// Where the ray meets that primitive first, whatever lies before it; not found where it passes it.
/// Where the primitive is the first that the ray meets, this is what a RayIndex answers, to the
/// bit. Takes no index: for those who know already what is seen.
Hit primitive_hit(const Scene& scene, const Ray& ray, std::uint64_t primitive);

/// The same of a ray that may start on a face.
Hit primitive_hit(const Scene& scene, const QueryRay& query, std::uint64_t primitive);

} // namespace vera
