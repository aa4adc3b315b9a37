// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/generate/generator.h"

#include <array>
#include <limits>

namespace vera {

// Scenes after the Standard Procedural Databases (Haines 1987): as many primitives of each kind,
// put together of subscenes that call one another.

constexpr std::array<Parameter, 1> balls_parameters = {{
    {"size", 4, 0, 12, true, "generations of smaller balls: (9^(size+1) - 1) / 8 balls in all"},
}};
Scene make_balls(const ParameterValues& values);

constexpr std::array<Parameter, 1> tetra_parameters = {{
    {"size", 6, 1, 20, true, "halvings of the tetrahedron: 4^size triangles in all"},
}};
Scene make_tetra(const ParameterValues& values);

constexpr std::array<Parameter, 1> jacks_parameters = {{
    {"size", 4, 1, 12, true, "generations of jacks: (8^size - 1) / 7 jacks in all"},
}};
Scene make_jacks(const ParameterValues& values);

constexpr std::array<Parameter, 1> lattice_parameters = {{
    {"size", 8, 1, 1000, true, "cells along each side: (size+1)^3 balls, 3 size (size+1)^2 rods"},
}};
Scene make_lattice(const ParameterValues& values);

constexpr std::array<Parameter, 1> rings_parameters = {{
    {"size", 5, 1, 100, true, "layers of the pyramid; layer n has n^2 clusters of 6 rings"},
}};
Scene make_rings(const ParameterValues& values);

constexpr std::array<Parameter, 3> branches_parameters = {{
    {"size", 11, 0, 24, true, "forks from the root to a tip: 2^(size+1) - 1 branches in all"},
    {"angle", 40, 0, 90, false, "degrees by which a branch leaves the one below it"},
    {"ratio", 0.67, 0.3, 0.9, false, "size of a branch by that of the one below it"},
}};
Scene make_branches(const ParameterValues& values);

constexpr std::array<Parameter, 3> shells_parameters = {{
    {"turns", 6, 1, 20, true, "turns of the spiral"},
    {"balls", 640, 3, 10'000, true, "balls in a turn"},
    {"growth", 2.56, 1.01, 10, false, "size of a turn by that of the one before it"},
}};
Scene make_shells(const ParameterValues& values);

} // namespace vera
