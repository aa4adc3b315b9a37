// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/base/parallel.h"
#include "vera/scene/camera.h"
#include "vera/scene/hit.h"
#include "vera/scene/scene.h"
#include "vera/visible/visible_map.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace vera {

/// A primitive of a source that has several.
struct JoinedPrimitive {
    std::uint32_t source = 0;
    std::uint64_t primitive = 0;

    friend auto operator<=>(const JoinedPrimitive&, const JoinedPrimitive&) = default;
};

/// A map of what is seen of a scene, and which primitives its sources are.
struct PrimitiveMap {
    const VisibleMap& map;
    std::vector<std::uint64_t> primitives;    ///< of each source, the first
    double cut_nearness = 0;                  ///< as in ScreenScene
    std::vector<JoinedPrimitive> joined = {}; ///< the others, sorted
};

struct MapCheckSettings {
    std::size_t points = 100000;
    double width = 1; ///< of the picture, in pixels
    double height = 1;
    double deviation = 0; ///< how far facets may lie off curved surfaces, in pixels
};

/// A place at which a map and a ray disagree.
struct MapDifference {
    double x = 0; ///< in pixels
    double y = 0;
    std::uint64_t drawn = no_primitive; ///< what the map shows; no_primitive is the background
    std::uint64_t traced = no_primitive;
    bool is_sound = true; ///< false: rings of several sources go round the place, or one twice
};

struct MapCheck {
    std::size_t points = 0;
    std::size_t near = 0;    ///< differences that the grid and the facets explain
    std::size_t far = 0;     ///< others
    std::uint64_t asked = 0; ///< primitives of what is drawn, one by one, where it differs
    std::optional<MapDifference> first_far;
};

/// Compares a map, at points spread at random over the picture, with the primitives that rays
/// through them meet first. A difference is explained where a side of the map is no farther than
/// 1/64 pixel from the point, or two surfaces that differ are no farther than that from each other
/// there; where one of them is curved, the deviation comes on top. The same points, and the same
/// result, for any number of threads. Throws Cancelled.
MapCheck check_map(
    const PrimitiveMap& drawn,
    const Scene& scene,
    const Camera& camera,
    const RayIndex& index,
    const MapCheckSettings& settings,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
