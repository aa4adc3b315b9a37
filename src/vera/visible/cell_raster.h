// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/exact/screen_point.h"
#include "vera/visible/screen_scene.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace vera {

/// No triangle is seen: the background.
constexpr std::uint32_t no_triangle = ~std::uint32_t{0};

/// A part of an edge that is seen, with different sources beside it, or one that different lights
/// reach.
struct VisiblePiece {
    RationalPoint from;
    RationalPoint to;
    ScreenPoint edge_begin; ///< of the whole edge, which runs the same way
    ScreenPoint edge_end;
    std::uint32_t left = no_triangle; ///< which are seen beside it
    std::uint32_t right = no_triangle;
    LightSet left_unlit = 0; ///< the lights that do not reach them there
    LightSet right_unlit = 0;
};

/// What is seen of a scene: all pieces of edges that part what is seen, each once.
struct VisiblePieces {
    std::vector<VisiblePiece> pieces;
    /// Triangles that pass through each other where both are seen, in ascending order, each pair
    /// once. Where there are any, the pieces need not close to outlines: see cut_penetrations().
    std::vector<std::pair<std::uint32_t, std::uint32_t>> penetrating;
};

/// By Franklin's cells: an edge is compared with what lies in the cells along it alone, all in
/// exact arithmetic (A linear time exact hidden surface algorithm, 1980). The time grows in
/// proportion to the triangles where what is hidden lies behind triangles larger than cells. The
/// same pieces in the same order for any number of threads.
VisiblePieces cell_raster(
    const ScreenScene& scene, const Progress& progress = {}, const CancelFlag* cancel = nullptr);

} // namespace vera
