// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/image.h"
#include "vera/math/color.h"

#include <cstdint>
#include <span>

namespace vera {

/// Writes display-referred colours over the pixels of row y from column x on, which must lie within
/// the picture. An 8 bit sample is round(255 min(1, max(0, value))), halves up; a 16 bit sample
/// likewise with 65535; a float is srgb_decoded(value), rounded to the nearest float and limited by
/// nothing. In integers what is not a number is 0. Different pixels may be developed by different
/// threads at once.
void develop(std::span<const Color> colors, Image& image, std::size_t x, std::size_t y);

/// A sample of 8 bits of the value, as develop() makes it.
std::uint8_t developed_byte(double value);

} // namespace vera
