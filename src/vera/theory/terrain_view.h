// SPDX-License-Identifier: Apache-2.0
// What is seen of a terrain, in steps that go with what is seen and not with what crosses behind
// it: O((n + v) log^2 n) for n triangles and v corners of the visible map, where a plane sweep
// takes O((n + k) log n) for k crossings, of hidden edges as well. Beyond the VERA paper: the first
// such algorithm is that of Reif and Sen (An efficient output-sensitive hidden surface removal
// algorithm and its parallelization, 1988); this one follows Katz, Overmars and Sharir (Efficient
// hidden surface removal for objects with small union size, 1992).
//
// The triangles come from the nearest to the farthest. What those before one of them cover is, in
// each column of the picture, all from the lower border of the terrain up to their profile, the
// upper envelope of their edges: so a profile is all that must be known of them. A balanced tree
// over the order has the profile of each node's own triangles, which is short (n alpha(n) parts,
// for n edges), merged from its children's. Then the tree is walked from the root with that part of
// the profile of everything before the node above which some of it is seen: what the farther child
// gets is raised by the nearer one's profile, and what lies under what the node itself can reach is
// left out. So each part that is carried belongs to the visible map, or to the merged profiles. At
// a leaf what is seen of a triangle remains.
#pragma once

#include "vera/base/parallel.h"
#include "vera/theory/profile.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/screen_scene.h"

#include <cstdint>

namespace vera {

/// The steps of terrain_pieces(), which are the same on every machine.
struct TerrainCounts {
    std::uint64_t ground = 0;    ///< triangles compared on the ground: see ground_order()
    std::uint64_t stretches = 0; ///< of x, looked at to compare profiles
    PlaneSweepCounts predicates; ///< orientations and comparisons, for these

    std::uint64_t steps() const {
        return ground + stretches + predicates.orientations + predicates.comparisons;
    }
};

/// The pieces that plane_sweep() and cell_raster() find, of surfaces without shadows, joined at
/// most as far. (Where two triangles that are no neighbours on the ground are so close that the
/// grid does not tell which is in front, those take that of the smaller source, and this takes the
/// nearer one. Where sources are numbered from the nearest on, they agree.) Throws InputError as
/// ground_order() does, and where what is seen is no terrain: where a triangle begins above what
/// lies before it in a column, or below the border of the terrain. Throws std::invalid_argument
/// where the scene has triangles of shadow, std::runtime_error where the memory that is available
/// would not suffice, and Cancelled.
VisiblePieces terrain_pieces(
    const ScreenScene& scene,
    Upward upward = Upward::against_y,
    TerrainCounts* counts = nullptr,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
