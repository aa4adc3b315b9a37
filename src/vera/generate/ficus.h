// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/generate/generator.h"

#include <array>

namespace vera {

constexpr std::array<Parameter, 6> ficus_parameters = {{
    {"age", 34, 1, 100, true, "leaves that the first shoot has made since it came up"},
    {"stems", 3, 1, 12, true, "shoots that come out of the earth"},
    {"dominance", 11, 1, 200, true, "leaves below a growing tip in which no bud wakes"},
    {"branching", 0.2, 0, 1, false, "chance that a bud wakes where it may"},
    {"triangles", 2000, 16, 100'000, true, "of a leaf, about"},
    {"seed", 3, 0, 1e9, true, "of the random numbers"},
}};
/// A rubber tree in a pot, grown leaf by leaf (VERA figure 2c). Lengths are in metres.
Scene make_ficus(const ParameterValues& values);

} // namespace vera
