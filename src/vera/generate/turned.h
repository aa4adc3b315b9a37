// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/primitives.h"

#include <cstdint>
#include <span>

namespace vera {

enum class ProfileForm : std::uint8_t {
    straight, ///< lines from point to point
    smooth    ///< cubic curves through the points; one that is given twice is a corner
};

/// The shape that a profile makes as it turns about the y axis: its points are distances r >= 0
/// from the axis, and heights. What it encloses with the axis is inside, in whichever order it is
/// given. Pieces of no length, and those along the axis at its ends, are left out; there may be
/// none left.
RotationalShape turned_shape(std::span<const ContourPiece::Point> profile, ProfileForm form);

} // namespace vera
