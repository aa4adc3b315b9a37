// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/screen_scene.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// Stands for no region: the background.
constexpr std::uint32_t no_region = ~std::uint32_t{0};

/// The picture cut into regions in which one source is seen each, which the same lights reach.
struct VisibleMap {
    /// May have several parts, and holes.
    struct Region {
        std::uint32_t source = 0;
        LightSet unlit = 0; ///< the lights that do not reach it

        friend auto operator<=>(const Region&, const Region&) = default;
    };

    /// A closed way along which the region is seen on the left: round a part of it, or, to the
    /// right, round a hole in it. Its points are ring_vertices[first] to [first + count], at each
    /// of which it turns, or something else begins to be seen on its right: ring_across of that
    /// number is the region there from that point on.
    struct Ring {
        std::uint32_t source = 0;
        std::uint32_t region = 0;
        std::size_t first = 0;
        std::size_t count = 0;
    };

    std::vector<PackedPoint> vertices;        ///< the points of the pieces
    std::vector<Region> regions;              ///< in ascending order
    std::vector<Ring> rings;                  ///< by region
    std::vector<std::uint32_t> ring_vertices; ///< one ring's behind the other's
    std::vector<std::uint32_t> ring_across;   ///< regions, or no_region; or empty: see RingDetail
    /// How often ways round what is seen had to be joined by a straight one: none but where
    /// triangles that pass through each other were left uncut, and at borders of shadows, where
    /// surfaces may part what is seen along lines a step from each other.
    std::size_t joined = 0;
    /// The longest straight way, in steps, that only one of the regions beside it has.
    double longest_join = 0;
    std::vector<std::size_t> joined_sides; ///< the straight ways: where they begin in ring_vertices

    /// The source, or no_source, that ring_across[place] is a region of.
    std::uint32_t source_across(std::size_t place) const {
        const std::uint32_t region = ring_across[place];
        return region == no_region ? no_source : regions[region].source;
    }

    std::span<const std::uint32_t> vertices_of(const Ring& ring) const {
        return std::span(ring_vertices).subspan(ring.first, ring.count);
    }
};

/// Throws Cancelled.
VisibleMap visible_map(
    const ScreenScene& scene,
    const VisiblePieces& pieces,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// The same, but the pieces give away their points, which the map has for vertices, and lights.
VisibleMap visible_map_with_points_of(
    VisiblePieces& pieces,
    const ScreenScene& scene,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// Whether a map tells what is seen across its rings: where nobody asks, ring_across stays empty.
enum class RingDetail : std::uint8_t { with_across, without_across };

/// The same where scene and pieces are not needed any more: takes half the memory.
VisibleMap visible_map(
    ScreenScene&& scene,
    VisiblePieces&& pieces,
    RingDetail detail,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// Twice the area that the ring encloses, about, in steps of the grid; negative round a hole.
double doubled_area(const VisibleMap& map, const VisibleMap::Ring& ring);

} // namespace vera
