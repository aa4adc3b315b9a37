// SPDX-License-Identifier: Apache-2.0
// The stages of cell_raster(), which those who look at parts of a scene go through in their own
// way.
#pragma once

#include "vera/base/parallel.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/edge_sweep.h"
#include "vera/visible/hidden_squares.h"
#include "vera/visible/seen_parts.h"
#include "vera/visible/sheets.h"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace vera {

/// How much of the time goes into what all edges are compared with.
constexpr double part_of_preparation = 0.2;

/// Tells, when edges are known and cells have no lists yet, which cells are asked for: see
/// AskedCells.
using AskedOfRaster = std::function<std::vector<std::uint8_t>(CellRaster&, const Cells&)>;

/// What all edges of the scene are compared with.
CellRaster raster_of(
    const ScreenScene& scene,
    const AskedOfRaster& asked,
    const Progress& progress,
    const CancelFlag* cancel);

/// Marks a byte that other threads may mark as well. Most are marked already, and are not taken
/// from another thread's cache to be written anew.
inline void mark_from_any_thread(std::uint8_t& byte) {
    const std::atomic_ref<std::uint8_t> shared(byte);
    if (shared.load(std::memory_order_relaxed) == 0)
        shared.store(1, std::memory_order_relaxed);
}

/// The cells along the edges that are asked for.
std::vector<std::uint8_t> cells_along(
    const std::vector<std::uint8_t>& is_edge_asked, const CellRaster& raster, const Cells& cells);

/// Behind the surfaces, of which the raster was made, its scene has shadows on some of them now:
/// adds what is told of these. What was added before is to be taken out first.
void add_shadows_to(
    CellRaster& raster,
    std::size_t first_triangle,
    std::size_t first_vertex,
    const HiddenSquares& squares,
    const CancelFlag* cancel);

/// Takes them out, down to so many triangles and edges.
void take_shadows_out(CellRaster& raster, std::size_t triangles, std::size_t edges);

/// How many pieces there will be of the edges from first to before last, about, and how many pairs
/// that pass through each other, as often as edges tell them: systematic sampling, in proportion to
/// lengths. None of edges that are not near what was changed.
struct ExpectedPieces {
    double pieces = 0;
    double pairs = 0;
};

ExpectedPieces expected_pieces(
    const CellRaster& raster, std::size_t first, std::size_t last, const CancelFlag* cancel);

/// Tells of the pieces which lights do not reach what is beside them, where no shadow is near.
void set_unlit(const CellRaster& raster, VisiblePieces& list);

/// Those of the pieces that are of edges that are there still, and far from the change; in the
/// light that reaches their sources where there is no shadow. In parts of all edges.
std::vector<EdgePart> kept_pieces(const CellRaster& raster, std::vector<SeenPart> before);

/// Follows the edges from first to before last that are near what was changed, or all, and adds
/// what is found, in parts, one behind the other.
void follow_edges(
    const CellRaster& raster,
    std::size_t first,
    std::size_t last,
    const Progress& progress,
    const CancelFlag* cancel,
    std::vector<SeenPart>& parts,
    CellCounts* counts = nullptr);

/// The same of these parts of the edges, whose kept pieces are taken in by their edges.
void follow_edges(
    const CellRaster& raster,
    std::vector<EdgePart> edges,
    const Progress& progress,
    const CancelFlag* cancel,
    std::vector<SeenPart>& parts,
    CellCounts* counts = nullptr);

/// Of each edge from that one on, how near it is in the planes of all triangles, from the first one
/// on, that have it.
std::vector<double>
nearness_of_edges(const CellRaster& raster, std::size_t first_triangle, std::size_t first_edge);

/// Of an edge that is so near, which eighths lie behind what covers their cells; all of a point.
/// Calls visit() for each cell, and each square of cells, that is looked at.
template <typename Visit>
std::uint8_t hidden_eighths(
    const CellRaster& raster,
    const HiddenSquares& squares,
    const ScreenEdges::Edge& edge,
    double near,
    const Visit& visit) {
    const ScreenPoint a = raster.scene.vertices[edge.begin].point;
    const ScreenPoint b = raster.scene.vertices[edge.end].point;
    std::uint8_t hidden = all_eighths;
    if (a == b || squares.hide(near, std::array{a, b}, visit))
        return hidden;
    const SegmentSlices slices(raster.cells, a, b);
    const std::int32_t count = slices.count();
    slices.for_each([&](const CellSlice& slice) {
        const std::uint8_t eighth = eighth_of(slice.number, count);
        if ((hidden & eighth) != 0 && !for_each_cell_of(slice, [&](std::size_t cell) {
                visit();
                return near < raster.cells.blocked[cell];
            }))
            hidden = static_cast<std::uint8_t>(hidden & ~eighth);
        return true;
    });
    return hidden;
}

void sort_pairs(std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs);

SeenPieces parted(VisiblePieces list);
VisiblePieces joined(SeenPieces seen);

/// As cell_raster() and cell_raster_after().
SeenPieces cell_raster_parts(
    const ScreenScene& scene,
    const Progress& progress,
    const CancelFlag* cancel,
    const ExpectPieces& expect,
    CellCounts* counts = nullptr);
SeenPieces cell_raster_parts_after(
    const SceneChange& change,
    std::span<const PackedPoint> open,
    SeenPieces before,
    const ScreenScene& scene,
    const Progress& progress,
    const CancelFlag* cancel,
    const ExpectPieces& expect);

} // namespace vera
