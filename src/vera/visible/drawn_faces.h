// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/scene/camera.h"
#include "vera/scene/facets.h"
#include "vera/scene/scene.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/screen_scene.h"

#include <cstdint>
#include <vector>

namespace vera {

/// What is drawn in one piece.
enum class FaceUnit : std::uint8_t {
    primitive, ///< curved ones as well
    plane,     ///< plane primitives and the plane pieces of others, and else each facet
    flat,      ///< as plane, but of a mesh what hangs together in one plane: see coplanar_patches.h
    smooth     ///< as flat, but of curved pieces that are convex all that shows the outside, and
               ///< all that shows the inside
};

/// What is told apart in a drawing, numbered in the order of the text. The facets of a plane face
/// (FaceUnit::plane) follow each other; those of larger ones need not.
struct DrawnFaces {
    std::vector<std::uint32_t> of_facet;    ///< the number of each facet's face
    std::vector<std::uint32_t> first_facet; ///< of each face
};

/// Whether the facet turns its outside to the viewer.
bool shows_outside(const Facets& facets, const Facets::Triangle& facet, const Camera& camera);

/// The camera tells the outside of a facet from its inside; only smooth ones ask for that. Throws
/// Cancelled.
DrawnFaces drawn_faces(
    const Scene& scene,
    const Facets& facets,
    FaceUnit unit,
    const Camera& camera = {},
    const CancelFlag* cancel = nullptr);

/// Makes the larger faces the sources.
void join_sources(ScreenScene& screen, const DrawnFaces& before, const DrawnFaces& after);

/// The same, and leaves out the pieces that parted one of them.
void join_sources(
    ScreenScene& screen, VisiblePieces& pieces, const DrawnFaces& before, const DrawnFaces& after);

} // namespace vera
