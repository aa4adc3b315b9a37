// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reference/faces.h"

namespace vera::reference {

/// Which side of a plane face is the outside: what the inner point said in the subscene's own
/// coordinates, and whether the placement mirrors, which turns the corners' order round.
struct PlaneSides {
    Outside outside = Outside::by_normal;
    bool mirrored = false;
};

/// P3, P4, PN: the corners in place.
std::unique_ptr<Face> polygon_face(std::vector<Vector> corners, PlaneSides sides);

/// PA: the corners in place and the normals carried there, not made unit.
std::unique_ptr<Face>
patch_face(std::vector<Vector> corners, std::array<Vector, 3> normals, PlaneSides sides);

} // namespace vera::reference
