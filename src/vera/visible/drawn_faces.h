// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/facets.h"
#include "vera/scene/scene.h"

#include <cstdint>
#include <vector>

namespace vera {

/// What is drawn in one piece.
enum class FaceUnit : std::uint8_t {
    primitive, ///< curved ones as well
    plane      ///< plane primitives, and of others each facet
};

/// What is told apart in a drawing, numbered in the order of the text.
struct DrawnFaces {
    std::vector<std::uint32_t> of_facet;    ///< the number of each facet's face
    std::vector<std::uint32_t> first_facet; ///< of each face
};

DrawnFaces drawn_faces(const Scene& scene, const Facets& facets, FaceUnit unit);

} // namespace vera
