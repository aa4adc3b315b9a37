// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/scene/light.h"

#include "prepared_scene.h"

namespace vera {

/// A white light for a scene that has none. It stands over the viewer's shoulder if two thirds of
/// what can be lit are lit from there, else where rays tell that they are: in a closed room,
/// within. Its numbers have few digits, and half of what is seen is as bright as by a light that
/// does not fall off, or brighter.
PointLight missing_light(const PreparedScene& prepared, const CancelFlag& cancel);

} // namespace vera
