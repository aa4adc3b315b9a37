// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/depth_plane.h"

namespace vera {

DepthPlane depth_plane(const std::array<ScreenVertex, 3>& corners) {
    const ScreenStep one = step(corners[0].point, corners[1].point);
    const ScreenStep other = step(corners[0].point, corners[2].point);
    const std::int64_t rise_one = corners[1].nearness - corners[0].nearness;
    const std::int64_t rise_other = corners[2].nearness - corners[0].nearness;
    return {
        corners[0].point,
        corners[0].nearness,
        rise_one * other.y - rise_other * one.y,
        rise_other * one.x - rise_one * other.x,
        cross(one, other)};
}

} // namespace vera
