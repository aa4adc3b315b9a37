// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/cells.h"
#include "vera/visible/screen_scene.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// The shadows in each cell, those on one source side by side: beside an edge only those on what is
/// seen there matter, of which there are few among thousands where many things throw on each other.
struct ShadowCells {
    std::vector<std::uint32_t> starts;    ///< as those of Cells; empty where there are none
    std::vector<std::uint32_t> triangles; ///< in ascending order of sources, and within one

    std::span<const std::uint32_t> shadows_of(std::size_t cell) const {
        return std::span(triangles).subspan(starts[cell], starts[cell + 1] - starts[cell]);
    }

    /// Those on one source. The scene must be that of the cells.
    std::span<const std::uint32_t>
    shadows_on(std::size_t cell, std::uint32_t source, const ScreenScene& scene) const;
};

/// In those cells, but where they are hidden. Throws std::runtime_error where the lists would not
/// fit into the memory that is available. slopes[i] is that of triangle i. Triangles before the
/// first one are no shadows.
ShadowCells shadow_cells_of(
    const Cells& cells,
    const ScreenScene& scene,
    std::span<const NearnessSlope> slopes,
    const CancelFlag* cancel = nullptr,
    std::size_t first_triangle = 0);

} // namespace vera
