// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/primitives.h"
#include "vera/solids/triangle_relation.h"

namespace vera {

/// What touches is often only nearly so, as a ball that rests on a slope: it crosses where it goes
/// deeper than this part of the radius, or of the sum of the radii.
constexpr double touching_part = 1e-6;

/// Whether the surfaces pass through each other, by more than touching. Not where one sphere is
/// within the other.
bool is_crossing(const Sphere& a, const Sphere& b);

/// Whether the triangle passes through the sphere's surface, by more than touching. Not where it is
/// within the sphere as a whole.
bool is_crossing(const Sphere& sphere, const TriangleCorners& triangle);

} // namespace vera
