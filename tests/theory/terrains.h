// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/screen_scene.h"

#include <cstdint>

namespace vera::testing {

/// Of which faces the triangles of a terrain are parts.
enum class TerrainSources : std::uint8_t { each_its_own, of_a_quadrangle, one_of_three };

/// A terrain of columns x rows quadrangles in an upright picture; y grows upward. Its first row of
/// corners lies at height 0, and nothing lies lower.
struct TerrainShape {
    std::int32_t columns = 4;
    std::int32_t rows = 4;
    std::int32_t heights = 3;   ///< that there are: 0, 1 .. heights - 1
    std::int32_t flat = 0;      ///< of so many corners more in that many + heights, the height is 0
    std::int32_t rise = 1;      ///< of a row over the one before, in halves of a height; 0: level
    std::int32_t narrowing = 0; ///< of all rows together, in quarter columns on each side
    bool is_shaken = false;     ///< corners of inner rows and columns move by a third of these
    TerrainSources sources = TerrainSources::each_its_own;
};

ScreenScene terrain(std::uint64_t seed, const TerrainShape& shape);

/// Steep hills of 2 side^2 triangles at a grazing view: each row reaches from the bottom of the
/// picture anywhere, so that in each column every row crosses every other.
ScreenScene steep_terrain(std::uint64_t seed, std::int32_t side);

/// A scene that nobody sees: two triangles lie before all of it, a slope that fills the picture.
ScreenScene behind_a_slope(ScreenScene scene);

/// The same upside down: y grows downward.
ScreenScene turned_over(const ScreenScene& scene);

} // namespace vera::testing
