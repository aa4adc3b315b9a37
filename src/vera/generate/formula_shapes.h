// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/generate/generator.h"

#include <array>

namespace vera {

// Surfaces whose formulas are given, as certified triangles with normals.

constexpr std::array<Parameter, 3> shell_parameters = {{
    {"turns", 6, 1, 20, false, "turns of the shell"},
    {"growth", 1.66, 1.05, 5, false, "size of a turn by that of the one before it"},
    {"deviation", 0.0005, 2e-5, 0.1, false, "length by which triangles may lie off the surface"},
}};
/// The snail shell of the paper, which calls it a snake shell (VERA figure 2i): its tip up.
Scene make_shell(const ParameterValues& values);

constexpr std::array<Parameter, 4> knot_parameters = {{
    {"p", 2, 1, 20, true, "times that the knot goes round the axis of its torus"},
    {"q", 3, 1, 20, true, "times that it goes round the torus itself"},
    {"thickness", 0.4, 0.01, 1, false, "radius of the rope; that of the torus is 2, of its tube 1"},
    {"deviation", 0.004, 5e-4, 0.1, false, "length by which triangles may lie off the surface"},
}};
/// A torus knot.
Scene make_knot(const ParameterValues& values);

/// A scene of one mesh.
Scene mesh_scene(Mesh mesh, const Affine3& placement = {});

/// z up becomes y up.
Affine3 z_up_to_y_up();

} // namespace vera
