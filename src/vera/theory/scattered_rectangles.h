// SPDX-License-Identifier: Apache-2.0
// What curves of rays among rectangles are counted of; the same on every machine.
#pragma once

#include "vera/theory/iso_rectangle.h"

#include <cstddef>
#include <random>
#include <vector>

namespace vera {

/// Within a cube. Sides are at most so many parts of the mean distance of as many points of a
/// square: with 2, rays meet some whatever the count is; with 0, none, so that nothing ends a
/// search early.
std::vector<IsoRectangle>
scattered_rectangles(std::size_t count, double parts, std::mt19937_64& random);

/// From anywhere within that cube, into any direction but along its rectangles.
WholeRay scattered_ray(std::mt19937_64& random);

} // namespace vera
