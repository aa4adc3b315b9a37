// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/ray.h"
#include "vera/scene/facets.h"
#include "vera/scene/hit.h"
#include "vera/scene/scene.h"

#include <cstdint>

namespace vera {

/// Where the ray, of unit direction, meets the plane of the facet with that number, not before its
/// t_min. Of one that is seen almost edge-on, which the grid knows badly, not beyond its corners.
double facet_t(const Facets& facets, std::uint32_t facet, const Ray& ray);

/// Where the ray, of unit direction, meets what it sees first, if others have found that to be the
/// facet: the primitive itself, or, where it passes that by, the facet's plane. That happens beside
/// silhouettes, of which a facet is a step of the grid off, and is on the surface once it is asked
/// for its normal.
Hit facet_hit(const Scene& scene, const Facets& facets, std::uint32_t facet, const Ray& ray);

} // namespace vera
