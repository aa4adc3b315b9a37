// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/camera.h"
#include "vera/scene/horizon_profile.h"
#include "vera/visible/border_ring.h"

#include <vector>

namespace vera {

/// Where the picture, of that width and height in pixels, shows the sky above the profile: rings
/// with the profile's points as corners. None where it shows the earth alone; the picture's own
/// four corners where it shows the sky alone.
std::vector<BorderRing>
sky_outline(const Camera& camera, const HorizonProfile& profile, double width, double height);

} // namespace vera
