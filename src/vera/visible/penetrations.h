// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/screen_scene.h"
#include "vera/visible/visibility_engine.h"

#include <cstddef>
#include <span>
#include <utility>

namespace vera {

/// Cuts triangles that pass through each other where they do, to within a step of the grid, and
/// those beside them that share a side which was cut. Of a triangle with several partners only some
/// cuts are made: ask again. Throws Cancelled.
SceneChange cut_penetrations(
    ScreenScene& scene,
    std::span<const std::pair<std::uint32_t, std::uint32_t>> penetrating,
    const CancelFlag* cancel = nullptr);

/// What is seen of the scene, and `left`, how many pairs still pass through each other: 0 but for
/// scenes in which hundreds do at one place.
struct WholePieces {
    VisiblePieces pieces;
    std::size_t left = 0;
    int rounds = 1;
    /// Points at which ways round what is seen did not close: near them all was asked again.
    std::size_t opened = 0;
};

/// What the engine finds in the scene after everything was cut in it that is seen to penetrate;
/// ways round all that is seen close, but where something is left, or within a step.
/// Throws Cancelled, and std::runtime_error where memory would not suffice for the engine.
WholePieces whole_pieces(
    ScreenScene& scene,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr,
    VisibilityEngine engine = VisibilityEngine::cells,
    const ExpectPieces& expect = {});

} // namespace vera
