// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/math/color.h"

#include <cmath>
#include <cstdint>

namespace vera {

/// The bytes that are nearest to the light, of which a screen shows from 0 to 1.
inline DrawingColor drawn_color(Color light) {
    const Color shown = clamped(light);
    const auto byte = [](double value) {
        return static_cast<std::uint8_t>(std::floor(255 * value + 0.5));
    };
    return {byte(shown.r), byte(shown.g), byte(shown.b)};
}

} // namespace vera
