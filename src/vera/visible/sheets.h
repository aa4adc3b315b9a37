// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/cells.h"
#include "vera/visible/edges.h"

#include <span>

namespace vera {

/// What is asked of triangles about the sheets that they make.
struct SheetScene {
    const ScreenScene& scene;
    const ScreenEdges& edges;
    std::span<const EdgeNeighbours> neighbours; ///< of the edges
    std::span<const NearnessSlope> slopes;      ///< of the triangles
};

/// Blocks cells by sheets: triangles that hang together, of which none alone covers the cell. Where
/// no border or fold of a sheet passes through a cell that it touches, it covers the cell. What
/// lies behind is then left out there. Throws Cancelled.
void block_by_sheets(Cells& cells, const SheetScene& sheets, const CancelFlag* cancel = nullptr);

} // namespace vera
