// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/generate/generator.h"

#include <array>

namespace vera {

constexpr std::array<Parameter, 4> terrain_parameters = {{
    {"detail", 7, 1, 11, true, "halvings of the square: 2^(2 detail + 1) triangles of ground"},
    {"roughness", 0.5, 0.1, 0.9, false, "heights of a halving by those of the one before it"},
    {"water", 0.36, 0, 1, false, "height of the water's surface between lowest and highest ground"},
    {"seed", 12, 0, 1e9, true, "of the random numbers"},
}};
/// A block of land by midpoint displacement (Fournier, Fussell and Carpenter 1982), with water,
/// grass, rock and snow. The ground and its cut sides have no gaps.
Scene make_terrain(const ParameterValues& values);

constexpr std::array<Parameter, 3> mountain_parameters = {{
    {"size", 6, 1, 11, true, "halvings: 2 4^size triangles"},
    {"roughness", 0.5, 0.1, 0.9, false, "heights of a halving by those of the one before it"},
    {"seed", 7, 0, 1e9, true, "of the random numbers"},
}};
/// A mountain of plain triangles with four shining balls over it, after the Standard Procedural
/// Databases.
Scene make_mountain(const ParameterValues& values);

} // namespace vera
