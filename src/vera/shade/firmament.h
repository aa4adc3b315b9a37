// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/color.h"
#include "vera/math/vec3.h"
#include "vera/scene/picture_settings.h"

#include <optional>

namespace vera {

/// What a ray that leaves the scene in that direction, a unit vector, sees: from the horizon up to
/// the sky above in proportion to the direction's y-part, the earth below. Black without firmament.
constexpr Color firmament_color(const std::optional<Firmament>& firmament, Vec3 direction) {
    if (!firmament)
        return {};
    if (direction.y < 0)
        return firmament->earth;
    return firmament->horizon + direction.y * (firmament->sky - firmament->horizon);
}

} // namespace vera
