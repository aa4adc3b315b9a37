// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/color.h"
#include "vera/math/vec3.h"
#include "vera/scene/picture_settings.h"

#include <algorithm>
#include <optional>

namespace vera {

/// Whether the earth is seen in that direction: below the profile or, where there is none, below
/// the level.
inline bool is_earth(const Firmament& firmament, Vec3 direction) {
    return firmament.profile ? firmament.profile->hides(direction) : direction.y < 0;
}

/// The sky in that direction, a unit vector: from the horizon up to the sky above in proportion to
/// the direction's y-part. A profile hides a part of it and does not change it; where one lies
/// below the level, the sky there is the horizon's.
constexpr Color sky_color(const Firmament& firmament, Vec3 direction) {
    return firmament.horizon + std::max(direction.y, 0.0) * (firmament.sky - firmament.horizon);
}

/// What a ray that leaves the scene in that direction, a unit vector, sees. Black without
/// firmament.
inline Color firmament_color(const std::optional<Firmament>& firmament, Vec3 direction) {
    if (!firmament)
        return {};
    return is_earth(*firmament, direction) ? firmament->earth : sky_color(*firmament, direction);
}

} // namespace vera
