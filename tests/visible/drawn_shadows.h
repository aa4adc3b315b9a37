// SPDX-License-Identifier: Apache-2.0
// Drawings with shadows, of scenes whose shadows several tests look at.
#pragma once

#include "vera/visible/shadows.h"
#include "vera/visible/visible_map.h"

#include <cstdint>
#include <optional>

namespace vera::testing {

/// Everything of a drawing with shadows.
struct DrawnShadows {
    Facets facets;
    DrawnFaces faces;
    ScreenScene screen; ///< with the shadows
    VisibleMap without; ///< shadows
    VisibleMap map;
    ShadowCounts counts;
};

DrawnShadows drawn_shadows(const Scene& scene, const Camera& camera);

/// Plane faces, and lights none of which lies in the plane of one, where rays may see either side.
Scene scene_of_planes(std::uint64_t seed, double scale = 1);

/// What the map shows at a place, or nothing where it is not one region.
std::optional<VisibleMap::Region> region_at(const VisibleMap& map, double x, double y);

} // namespace vera::testing
