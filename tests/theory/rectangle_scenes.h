// SPDX-License-Identifier: Apache-2.0
// Rectangles one behind the other, with corners on so few places that sides coincide and touch.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "theory/rectangles.h"

namespace vera::testing {

/// A way to make some; their corners lie from 0 to scene_side each way.
struct RectangleScene {
    const char* name;
    Rectangles (*rectangles)(std::mt19937_64& random);
};

constexpr std::int32_t scene_side = 12;

const std::vector<RectangleScene>& rectangle_scenes();

} // namespace vera::testing
