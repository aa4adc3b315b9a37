// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/camera.h"

namespace vera::testing {

/// Cameras all round a scene about the origin, some of parallel rays, some within it.
Camera camera_number(int number);

} // namespace vera::testing
