// SPDX-License-Identifier: Apache-2.0
// Lists of pieces that were found apart from each other, as one, in which each point is there once.
// They are the largest thing of a drawing: whatever of them is done with is freed at once.
#pragma once

#include "vera/visible/cell_raster.h"

#include <cstdint>
#include <vector>

namespace vera {

/// The parts one behind the other.
VisiblePieces joined(std::vector<VisiblePieces> parts);

/// Leaves out the other pieces and, where these are most, the points that only they have.
void keep_pieces(const std::vector<std::uint8_t>& is_kept, VisiblePieces& list);

/// The pieces before, and the ones that were found, which are of other edges, by their edges: as if
/// all had been found together. Lights are those of both; what penetrates is that which was found.
VisiblePieces merged(VisiblePieces before, VisiblePieces found);

} // namespace vera
