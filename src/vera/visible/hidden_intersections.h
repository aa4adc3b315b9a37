// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/exact/screen_point.h"
#include "vera/visible/screen_scene.h"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace vera {

/// A part, behind something, of the line along which two triangles pass through each other.
struct HiddenIntersection {
    RationalPoint from;
    RationalPoint to;
    ScreenPoint begin; ///< of the whole line, with its ends on the grid
    ScreenPoint end;
    std::array<std::uint32_t, 2> triangles = {};
};

/// Of all triangles of different sources that pass through each other by more than the grid may
/// have made them (FrontOrder::penetrating), and of which is_asked(one, other), the parts of the
/// line where they do that something covers on both of its sides. The triangles must be those of
/// screen_scene(), not cut. The ends of lines of triangles with a common side are common ones.
std::vector<HiddenIntersection> hidden_intersections(
    const ScreenScene& scene,
    const std::function<bool(std::uint32_t, std::uint32_t)>& is_asked,
    const CancelFlag* cancel = nullptr);

} // namespace vera
