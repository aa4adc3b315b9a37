// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/exact/front_order.h"
#include "vera/visible/screen_scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// Whether what something else surely hides is left out before triangles are put in order.
enum class Hiding : std::uint8_t { by_what_covers, by_nothing };

/// Of each triangle.
std::vector<NearnessSlope> slopes_of(const ScreenScene& scene);

/// The part of a line that lies in a triangle. It is found on the triangle's sides, so that it is
/// the same by whatever points the line is given.
struct Chord {
    NearnessPlace from;
    NearnessPlace to;
    double from_at = 0; ///< the coordinate in which the line is longer; not more than to_at
    double to_at = 0;
};

/// In the line from begin to end, which passes through the triangle or along one of its sides.
Chord chord_in(const std::array<ScreenVertex, 3>& corners, ScreenPoint begin, ScreenPoint end);

/// A triangle where a line meets it.
struct OnLine {
    std::uint32_t triangle = 0;
    Chord chord;
};

/// Which of two triangles that both lie along a line is in front there: first, second, or
/// penetrating where none is all along, or anywhere else. Of coincident ones that of the smaller
/// source, then of the smaller number is in front. slopes[i] is that of triangle i.
FrontOrder triangle_order(
    const ScreenScene& scene,
    std::span<const NearnessSlope> slopes,
    const OnLine& a,
    const OnLine& b);

/// The same by all places at which both are.
FrontOrder triangle_order(
    const ScreenScene& scene,
    std::span<const NearnessSlope> slopes,
    std::uint32_t a,
    std::uint32_t b);

} // namespace vera
