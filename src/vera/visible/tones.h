// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/color.h"
#include "vera/scene/material.h"

namespace vera {

/// What a surface of the material looks like as a cartoon: its own colour in one of three tones, by
/// how much of it the light brings out. The light is what the surface gives back.
Color toned(Color light, const Material& material);

} // namespace vera
