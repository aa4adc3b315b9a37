// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/scene/camera.h"
#include "vera/scene/facets.h"
#include "vera/scene/scene.h"

#include <cstdint>
#include <vector>

namespace vera {

/// What is drawn in one piece.
enum class FaceUnit : std::uint8_t {
    primitive, ///< curved ones as well
    plane,     ///< plane primitives and the plane pieces of others, and else each facet
    smooth     ///< as plane, but of curved pieces that are convex all that shows the outside, and
               ///< all that shows the inside
};

/// What is told apart in a drawing, numbered in the order of the text.
struct DrawnFaces {
    std::vector<std::uint32_t> of_facet;    ///< the number of each facet's face
    std::vector<std::uint32_t> first_facet; ///< of each face
};

/// The camera tells the outside of a facet from its inside; only smooth ones ask for that. Throws
/// Cancelled.
DrawnFaces drawn_faces(
    const Scene& scene,
    const Facets& facets,
    FaceUnit unit,
    const Camera& camera = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
