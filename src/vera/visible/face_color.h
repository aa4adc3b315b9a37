// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/visible/fill_sources.h"
#include "vera/visible/visible_map.h"

#include <optional>
#include <span>

namespace vera {

/// The one colour of a region, given by its rings, in the styles that have one: that of the face in
/// the light that its largest ring gets in the middle, or one of three tones of it.
DrawingColor region_color(const FillSources& sources, std::span<const VisibleMap::Ring> region);

/// What is behind all faces. Nothing in style shaded, whose sky is areas, where lines alone are
/// drawn, and of numbers.
std::optional<DrawingColor> background_color(const FillSources& sources);

} // namespace vera
