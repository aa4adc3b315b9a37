// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/solids/solid_faces.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// The side of a face that is no other face's.
struct OpenEdge {
    std::uint32_t from = 0; ///< a point
    std::uint32_t to = 0;
    std::uint32_t face = 0;

    friend bool operator==(const OpenEdge&, const OpenEdge&) = default;
};

/// Faces that hang together by their edges.
struct Shell {
    std::vector<std::uint32_t> faces; ///< in text order
    std::size_t edges = 0;
    std::vector<OpenEdge> open;
    bool is_closed = false; ///< each edge belongs to two faces
    /// Whether it is known on which side of each face the solid is: of a closed one that rounding
    /// leaves no doubt of, and of one with holes where all lies on one side of each face.
    bool has_inside = false;
    /// Then, of each face: whether its corners run clockwise as seen from outside.
    std::vector<bool> is_turned;
};

/// In the order of their first faces. Takes n log n for n corners.
std::vector<Shell> shells(const SolidFaces& faces);

} // namespace vera
