// SPDX-License-Identifier: Apache-2.0
// Lists of pieces that were found apart from each other, as one, in which each point is there once.
// They are the largest thing of a drawing: whatever of them is done with is freed at once.
#pragma once

#include "vera/base/free_room.h"
#include "vera/visible/cell_raster.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// Gives back what was freed in small blocks, whenever that is much: what is made of parts takes
/// the room of those that are done with, and does not stand beside it.
class FreedBlocks {
public:
    template <typename T>
    void free(std::vector<T>& vector) {
        constexpr std::size_t much = std::size_t{6} << 20U;
        bytes_ += vector.capacity() * sizeof(T);
        free_room(vector);
        if (bytes_ < much)
            return;
        give_back_freed_memory();
        bytes_ = 0;
    }

private:
    std::size_t bytes_ = 0;
};

/// The parts one behind the other. With room for so many other pieces, which are merged in later.
VisiblePieces joined(std::vector<VisiblePieces> parts, std::size_t others = 0);

/// Parts that are the list when they are joined again, without its lights and what penetrates: each
/// has points of its own, so that it can be forgotten before the others.
std::vector<VisiblePieces> parted(const VisiblePieces& list);

/// Leaves out the other pieces and the points that only they have. The list keeps its room, but not
/// the memory of what is not used.
void keep_pieces(const std::vector<std::uint8_t>& is_kept, VisiblePieces& list);

/// The pieces before, and the ones that were found, which are of other edges, by their edges: as if
/// all had been found together. Lights are those of both; what penetrates is that which was found.
/// Done in the room of the larger list, where that suffices.
VisiblePieces merged(VisiblePieces before, VisiblePieces found);

} // namespace vera
