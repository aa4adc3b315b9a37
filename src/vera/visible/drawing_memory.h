// SPDX-License-Identifier: Apache-2.0
// What a drawing takes of memory, told before it does. In bytes, from counts of what there is and
// what each was measured to take; see tests/visible/drawing_memory_test.cpp.
#pragma once

#include "vera/scene/facets.h"
#include "vera/visible/drawing_style.h"
#include "vera/visible/screen_scene.h"
#include "vera/visible/seen_parts.h"

#include <cstddef>

namespace vera {

/// How much there is in a scene on the screen.
struct ScreenCounts {
    std::size_t surfaces = 0; ///< triangles
    std::size_t shadows = 0;  ///< triangles
    std::size_t vertices = 0;
    std::size_t curved = 0; ///< of the surfaces, those that are facets of curved ones, about
};

ScreenCounts counts_of(const ScreenScene& scene);

/// Which part of the facets is of curved surfaces, about: of primitives in 32 facets and more.
double curved_part_of(const Facets& facets);

/// What all edges are compared with while cell_raster() runs, beside the scene.
double raster_bytes(const ScreenCounts& counts);

/// The pieces, and pairs of triangles that pass through each other, while cell_raster() finds them
/// and keeps them like that.
double piece_bytes(double pieces, double pairs = 0, PieceStorage storage = PieceStorage::plain);

/// What is made of so many pieces, from the map to the text of the file, in place of what edges
/// were compared with. Where outlines are made later, the text is in the file and not in memory.
double
drawing_bytes(double pieces, const ScreenCounts& counts, DrawingStyle style, FaceOutlines outlines);

/// Throws std::runtime_error where the memory that is available does not suffice for cell_raster()
/// of the scene, whatever is seen of it.
void require_raster_memory(const ScreenScene& scene);

/// The same of the pieces and pairs, if so many are expected.
void require_piece_memory(
    double pieces, double pairs = 0, PieceStorage storage = PieceStorage::plain);

/// The same of the whole drawing, while cell_raster() has what edges are compared with.
void require_drawing_memory(
    double pieces, const ScreenCounts& counts, DrawingStyle style, FaceOutlines outlines);

/// The same of the list of what throws shadows, if it has so many.
void require_throw_memory(std::size_t throws);

} // namespace vera
