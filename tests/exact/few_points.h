// SPDX-License-Identifier: Apache-2.0
// Points of few coordinates, so that many are equal, on one line or on the border of the picture.
#pragma once

#include "vera/exact/screen_point.h"

#include <array>
#include <cstdint>
#include <random>

namespace vera::testing {

/// The least, the largest, and some between.
inline std::int32_t few_coordinate(std::mt19937_64& random) {
    constexpr std::array<std::int32_t, 8> numbers = {
        0, 1, 2, 3, screen_size / 2, screen_size - 2, screen_size - 1, screen_size};
    return numbers[random() % numbers.size()];
}

inline ScreenPoint few_point(std::mt19937_64& random) {
    const std::int32_t x = few_coordinate(random);
    return {x, few_coordinate(random)};
}

} // namespace vera::testing
