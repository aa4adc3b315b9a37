// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/sphere_index.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sample_mesh.h"

namespace vera::testing {

using SampleSpheres = std::vector<std::array<float, 4>>;

/// Spheres whose centers and radii have few values, so that many coincide, touch each other, share
/// their centers, or are points.
SampleSpheres random_spheres(std::uint64_t seed, std::size_t count);

/// A copy whose centers are factor * center + offset and whose radii factor * radius, rounded.
SampleSpheres scaled_and_shifted(SampleSpheres spheres, float factor, float offset);

/// Spheres of one center, or nearly, nearer to each other than single precision tells apart where
/// rays meet them.
SampleSpheres close_shells(std::uint64_t seed, std::size_t count);

/// Random spheres as small and as large as single precision allows, mixed.
SampleSpheres mixed_spheres(std::uint64_t seed, std::size_t count);

/// Random spheres, some of which are far smaller than the others.
SampleSpheres small_spheres_beside_large(std::uint64_t seed, std::size_t small);

/// A copy in which some numbers are none, or infinite, and some radii negative.
SampleSpheres with_broken_numbers(SampleSpheres spheres, std::uint64_t seed);

/// Small spheres about a large one, as many as a grid of its surface has places.
SampleSpheres ball_of_balls(std::size_t around);

/// What random_mesh_rays() and its like take for such spheres: their centers, poles, and points on
/// lines that touch them, so that rays go through centers, along diameters, and touch.
SampleMesh places_about(const SampleSpheres& spheres);

} // namespace vera::testing
