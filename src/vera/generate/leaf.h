// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/primitives.h"

#include <cstddef>

namespace vera {

/// The form of a leaf's blade. It begins at the origin and goes along y, 1 long; its upper side
/// looks along z.
struct LeafForm {
    double half_width = 0.22; ///< at the widest place
    double widest = 0.42;     ///< place of it, from 0 at the stalk to 1 at the tip
    double fold = 0.35;       ///< slope of the halves up from the midrib
    double droop = 0.25;      ///< how far the tip sinks
    double waves = 0.015;     ///< height of the margin's
    std::size_t rows = 40;    ///< of triangles along the midrib
    std::size_t columns = 8;  ///< on each side of it
};

/// A mesh with normals of 4 rows columns triangles, less those at the two ends; its coordinates are
/// multiples of 1e-6 so that texts of it are short.
Mesh leaf_blade(const LeafForm& form);

} // namespace vera
