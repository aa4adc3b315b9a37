// SPDX-License-Identifier: Apache-2.0
// Generations of a picture's rays, as curves are counted of them (VERA 3.3.2): those of a viewer,
// which cross nowhere before it, and those that a sphere mirrors, which do. A plane mirror makes of
// the first a generation of the same kind, as if the viewer stood behind it.
//
// All is within a cube whose steps across are finer than those along z, so that whole slopes tell
// directions apart. The same for the same state on every machine.
#pragma once

#include "vera/theory/iso_rectangle.h"
#include "vera/theory/sloped_ray.h"

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace vera {

/// The cube goes from -20 000 to 20 000 along z, and so many times as far along x and y.
constexpr std::int32_t fine_steps = 1000;

/// scattered_rectangles(), in this cube.
std::vector<IsoRectangle>
finely_scattered_rectangles(std::size_t count, double parts, std::mt19937_64& random);

/// All through one point, at that distance before the middle along z, from there on; slopes within
/// the steepest.
std::vector<SlopedRay> rays_of_viewer(
    std::size_t count, std::int32_t distance, std::int32_t steepest, std::mt19937_64& random);

/// Those of a viewer in the middle of the cube's near face, all of which stay in the cube.
std::vector<SlopedRay> first_generation(std::size_t count, std::mt19937_64& random);

/// Rays of a viewer beside the middle of the far face, mirrored by a sphere around the middle of
/// the near one, from its surface on; those that go on along z by no less than along x or y.
std::vector<SlopedRay> mirrored_generation(std::size_t count, std::mt19937_64& random);

/// The same for structures that are asked of one ray in whole numbers, among
/// scattered_rectangles(): steps are alike in all directions.
WholeRay first_generation_ray(std::mt19937_64& random);
WholeRay mirrored_generation_ray(std::mt19937_64& random);

} // namespace vera
