// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/cell_raster.h"
#include "vera/visible/screen_scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// The picture cut into regions in which one source is seen each.
struct VisibleMap {
    /// A closed way along which the source is seen on the left: round a region, or, to the right,
    /// round a hole in it. Its points are ring_vertices[first] to [first + count], at each of which
    /// it turns, or something else begins to be seen on its right: ring_across of that number is
    /// what is seen there from that point on.
    struct Ring {
        std::uint32_t source = 0;
        std::size_t first = 0;
        std::size_t count = 0;
    };

    std::vector<RationalPoint> vertices;
    std::vector<std::array<std::uint32_t, 2>> piece_ends; ///< the vertices of each piece
    std::vector<Ring> rings;                              ///< by source
    std::vector<std::uint32_t> ring_vertices;
    std::vector<std::uint32_t> ring_across; ///< sources, or no_source
    /// How often ways round what is seen had to be joined by a straight one. None where nothing was
    /// cut; else two surfaces may part what is seen along lines a step from each other, between
    /// which neither is seen for sure.
    std::size_t joined = 0;

    std::span<const std::uint32_t> vertices_of(const Ring& ring) const {
        return std::span(ring_vertices).subspan(ring.first, ring.count);
    }
};

VisibleMap visible_map(const ScreenScene& scene, const VisiblePieces& pieces);

/// Twice the area that the ring encloses, about, in steps of the grid; negative round a hole.
double doubled_area(const VisibleMap& map, const VisibleMap::Ring& ring);

} // namespace vera
