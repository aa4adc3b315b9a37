// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/drawing.h"
#include "vera/scene/picture_settings.h"
#include "vera/visible/visible_map.h"

#include <cstdint>
#include <span>

namespace vera {

/// The bytes of the number as red, green and blue: style ids. 0 is the background.
DrawingColor color_of_number(std::uint64_t number);

/// The regions of the map in the colours of their primitives' numbers, counted from 1, straight
/// from vertex to vertex. These are to be compared, not looked at: the colour says all, and the
/// file stays small. primitives are those of the sources. Takes apart the map, for which there
/// would be no room beside the areas. Throws Cancelled.
SharedAreas numbered_areas(
    VisibleMap map,
    std::span<const std::uint64_t> primitives,
    const PictureSettings& picture,
    const CancelFlag* cancel = nullptr);

} // namespace vera
