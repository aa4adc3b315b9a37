// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/screen_scene.h"
#include "vera/visible/shadows.h"

#include <cstddef>

namespace vera {

/// What is seen of a scene in its shadows: as cell_raster() of the screen after add_on() of all
/// faces. But the shadows are made for a part of
/// the edges at a time, and are forgotten after: a scattered triangle has ten of them, of 200 bytes
/// each with what they are compared by.
///
/// Beside a surface's edge only the shadows matter that lie on what is seen there, or on the
/// surface: `before` tells it, the pieces of the same screen without shadows. Beside an edge of a
/// shadow only those on the same face do. So the surfaces' edges are followed first, along the
/// curve by which they are sorted, and then the shadows' face by face. Each shadow is made about
/// twice; where faces are seen between each other all over the picture a few times, with more of
/// them at a time.
struct ShadowedPieces {
    VisiblePieces pieces;
    std::size_t shadows = 0; ///< triangles that were made of what was thrown
    std::size_t made = 0;    ///< of what was thrown, what was made beside surfaces' edges, with
                             ///< what was made again
};

/// The screen gets the vertices between which pieces of shadows' borders lie, and keeps its
/// triangles. Throws Cancelled, and std::runtime_error where the memory that is available would not
/// suffice. So many shadows may be there at a time at first, or those of a 32nd as many
/// triangles as the screen has: the pieces do not depend on it.
ShadowedPieces shadowed_cell_raster(
    ScreenScene& screen,
    VisiblePieces before,
    ThrownShadows thrown,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr,
    const ExpectPieces& expect = {},
    std::size_t at_a_time = 4096);

} // namespace vera
