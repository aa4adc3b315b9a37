// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/exact/screen_point.h"

#include <cstdint>

namespace vera {

/// A step between two points of the picture, in half the room of other ones: there may be millions.
struct LineStep {
    LineStep() = default;

    LineStep(ScreenStep step) // NOLINT: the same in other words
        : x(static_cast<std::int32_t>(step.x))
        , y(static_cast<std::int32_t>(step.y)) {}

    operator ScreenStep() const { return {x, y}; } // NOLINT

    std::int32_t x = 0;
    std::int32_t y = 0;
};

} // namespace vera
