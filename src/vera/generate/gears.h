// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/generate/generator.h"

#include <array>

namespace vera {

constexpr std::array<Parameter, 4> gear_parameters = {{
    {"teeth", 24, 6, 200, true, "of the gear"},
    {"pressure",
     20,
     10,
     30,
     false,
     "angle in degrees at which teeth press on those of another gear"},
    {"width", 6, 0.5, 50, false, "of the gear along its axis; a tooth is pi / 2 thick"},
    {"bore", 0.35, 0.05, 0.8, false, "radius of the hole by that of the pitch circle"},
}};
/// A spur gear of module 1 with involute teeth, its axis z.
Scene make_gear(const ParameterValues& values);

constexpr std::array<Parameter, 3> gears_parameters = {{
    {"first", 30, 6, 200, true, "teeth of the first gear"},
    {"second", 14, 6, 200, true, "of the second, which meshes with it"},
    {"third", 20, 6, 200, true, "of the third, which meshes with the second"},
}};
/// Three spur gears that mesh, on a plate.
Scene make_gears(const ParameterValues& values);

/// What a spur gear of module 1 is cut by; pitch radius teeth / 2, teeth 1 high above it and 1.25
/// deep below.
struct GearForm {
    std::size_t teeth = 24;
    double pressure_degrees = 20;
    double width = 6;
    double bore_radius = 4;
};

/// The outline of one tooth in the plane across the axis, from the middle of a gap to the middle of
/// the next, counterclockwise; the tooth is about the x axis. Flanks are involutes of the base
/// circle where they are outside it, and radial below.
std::vector<Vec3> tooth_outline(const GearForm& form);

} // namespace vera
