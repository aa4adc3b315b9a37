// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/exact/packed_point.h"
#include "vera/visible/cell_counts.h"
#include "vera/visible/edges.h"
#include "vera/visible/screen_scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace vera {

/// A part of an edge that is seen, with different sources beside it, or one that different lights
/// reach.
struct VisiblePiece {
    std::uint32_t from = 0; ///< points, in the direction of the edge
    std::uint32_t to = 0;
    ScreenEdges::Edge edge;
    std::uint32_t left = no_triangle; ///< which are seen beside it
    std::uint32_t right = no_triangle;
};

/// The lights that do not reach what is seen beside a piece.
struct UnlitBeside {
    LightSet left = 0;
    LightSet right = 0;
};

/// What is seen of a scene: all pieces of edges that part what is seen, each once.
struct VisiblePieces {
    std::vector<PackedPoint> points;  ///< at which pieces end, each once
    std::vector<VisiblePiece> pieces; ///< by their edges' vertices
    std::vector<UnlitBeside> unlit;   ///< of each piece; or empty: all lights reach everything
    /// Triangles that pass through each other where both are seen, in ascending order, each pair
    /// once. Where there are any, the pieces need not close to outlines: see cut_penetrations().
    std::vector<std::pair<std::uint32_t, std::uint32_t>> penetrating;

    UnlitBeside unlit_beside(std::size_t piece) const {
        return unlit.empty() ? UnlitBeside{} : unlit[piece];
    }
};

/// Told about how many pieces there will be before they are found; throws where they are too many.
using ExpectPieces = std::function<void(double pieces)>;

/// By Franklin's cells: an edge is compared with what lies in the cells along it alone, all in
/// exact arithmetic (A linear time exact hidden surface algorithm, 1980). The time grows in
/// proportion to the triangles where what is hidden lies behind triangles larger than cells. The
/// same pieces in the same order for any number of threads. Where counts are asked for they are
/// filled in. Throws Cancelled, and std::runtime_error where the memory that is available would not
/// suffice: it first follows a few edges.
VisiblePieces cell_raster(
    const ScreenScene& scene,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr,
    const ExpectPieces& expect = {},
    CellCounts* counts = nullptr);

/// What became different in a scene, whose other triangles and whose vertices kept their numbers.
struct SceneChange {
    std::vector<std::uint32_t> triangles;            ///< that are new, or other ones than before
    std::vector<std::array<ScreenVertex, 3>> places; ///< where the others were that are no more
    std::vector<PackedPoint> asked; ///< near which nothing was changed, but all is asked again
};

/// As cell_raster() of the changed scene, but follows only the edges near what was changed. Near
/// the open points nothing is left out of what lies beside these, however surely something else
/// hides it. `before` are the pieces of the scene before; whichever lights reached a source nowhere
/// then.
VisiblePieces cell_raster_after(
    const SceneChange& change,
    std::span<const PackedPoint> open,
    VisiblePieces before,
    const ScreenScene& scene,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr,
    const ExpectPieces& expect = {});

} // namespace vera
