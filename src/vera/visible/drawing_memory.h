// SPDX-License-Identifier: Apache-2.0
// What a drawing takes of memory, told before it does. In bytes, from counts of what there is and
// what each was measured to take; see tests/visible/drawing_memory_test.cpp.
#pragma once

#include "vera/visible/drawing_style.h"
#include "vera/visible/screen_scene.h"

#include <cstddef>

namespace vera {

/// How much there is in a scene on the screen.
struct ScreenCounts {
    std::size_t surfaces = 0; ///< triangles
    std::size_t shadows = 0;  ///< triangles
    std::size_t vertices = 0;
};

ScreenCounts counts_of(const ScreenScene& scene);

/// What all edges are compared with while cell_raster() runs, beside the scene.
double raster_bytes(const ScreenCounts& counts);

/// The pieces, and pairs of triangles that pass through each other, while cell_raster() finds them.
double piece_bytes(double pieces, double pairs = 0);

/// What is made of so many pieces of so many surfaces, from the map to the text of the file, beside
/// the pieces.
double drawing_bytes(
    double pieces,
    std::size_t surfaces,
    DrawingStyle style,
    FaceOutlines outlines = FaceOutlines::now);

/// Throws std::runtime_error where the memory that is available does not suffice for cell_raster()
/// of the scene, whatever is seen of it.
void require_raster_memory(const ScreenScene& scene);

/// The same of the pieces and pairs, if so many are expected.
void require_piece_memory(double pieces, double pairs = 0);

/// The same of the whole drawing.
void require_drawing_memory(
    double pieces,
    std::size_t surfaces,
    DrawingStyle style,
    FaceOutlines outlines = FaceOutlines::now);

/// Looks, while shadows are added to a scene, whether there will be memory to see them.
class ShadowMemory {
public:
    explicit ShadowMemory(const ScreenScene& screen)
        : before_(counts_of(screen)) {}

    /// Throws std::runtime_error where that does not suffice for the screen as it was with so many
    /// more shadows of a light, of which each becomes about one triangle.
    void require(std::size_t shadows) const;

private:
    ScreenCounts before_;
};

} // namespace vera
