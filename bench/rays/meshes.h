// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/primitives.h"

#include <cstddef>
#include <cstdint>

namespace vera {

// Meshes to shoot rays at, the same on every machine. y is up but in the sphereflake.

/// A sphere with nine a third of its size on it, nine on each of those and so on (the `balls` of
/// Haines' Standard Procedural Databases): so many generations after the first, each sphere an
/// octahedron whose faces are divided so often.
struct Sphereflake {
    std::uint32_t generations = 4;
    std::uint32_t divisions = 2;
};

Mesh tessellated(const Sphereflake& flake);

/// A closed hall with fluted columns, 60 by 16 by 36 round (0, 8, 0): no ray leaves it. There are
/// segments corners round each column.
Mesh hall_mesh(std::size_t segments);

/// A square of 2 by 2 round the origin, displaced level by level; side is a power of two.
Mesh mountain_mesh(std::size_t side);

/// A tree about 10 high that forks so many times, with leaves, on a piece of ground.
Mesh tree_mesh(std::uint32_t forks);

/// A bowl 220 long with rows of seats round a flat ground at height 0, with so many corners along
/// each row.
Mesh stadium_mesh(std::size_t segments);

/// Adds a copy of the part to the mesh, scaled to be so long along x, its lowest point and the
/// middle of its extent at the place.
void add_model(Mesh& mesh, const Mesh& part, double size, Vec3 place);

/// Moves every corner to where floats can be: what both sides of a comparison then see.
void round_to_floats(Mesh& mesh);

} // namespace vera
