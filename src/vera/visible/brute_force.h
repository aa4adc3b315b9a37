// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/screen_scene.h"

#include <cstdint>

namespace vera {

/// What is seen at the middle of the square of the grid that begins at the point, by asking every
/// triangle: the reference for everything faster. Nothing is told of points on the side of a
/// triangle: has_side_at is then set.
struct SeenAt {
    std::uint32_t source = 0; ///< or no_source
    LightSet unlit = 0;       ///< the lights that do not reach it there
    bool has_side_at = false;
};

/// point is in half steps of the grid.
SeenAt seen_at(const ScreenScene& scene, std::int64_t x_in_halves, std::int64_t y_in_halves);

} // namespace vera
