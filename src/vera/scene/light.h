// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/color.h"
#include "vera/math/vec3.h"

namespace vera {

/// How light grows weaker with the distance d: not at all (as in NFF), or by 1 / d^2.
enum class Falloff { none, inverse_square };

/// LI x y z intensity r g b
struct PointLight {
    Vec3 position;
    double intensity = 1;
    Color color = {1, 1, 1};
    Falloff falloff = Falloff::inverse_square;
};

} // namespace vera
