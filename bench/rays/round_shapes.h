// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/primitives.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

// Round things to shoot rays at, the same on every machine.

/// A sphere of radius 0.5 round the origin with nine a third of its size on it, nine on each of
/// those and so on, so many generations after the first: the `balls` of Haines' Standard Procedural
/// Databases, but for how they are turned. Each stands before those on it.
std::vector<Sphere> flake_spheres(std::uint32_t generations);

/// 180 times 2 to the power of size spheres, and one, that overlap along a growing spiral
/// (Pickover, A short recipe for seashell synthesis, 1989): the `shells` of the same databases.
std::vector<Sphere> shell_spheres(std::uint32_t size);

/// side x side goblets of lines, arcs of conics and cubic curves, 1 apart on the plane of height 0
/// round the origin, no two of the same height and width; y is up.
std::vector<RotationalShape> goblet_shapes(std::size_t side);

} // namespace vera
