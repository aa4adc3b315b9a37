// SPDX-License-Identifier: Apache-2.0
// Lists of pieces that were found apart from each other, as one, in which each point is there once.
// They are the largest thing of a drawing: whatever of them is done with is freed at once.
#pragma once

#include "vera/base/free_room.h"
#include "vera/visible/seen_parts.h"

#include <cstddef>
#include <vector>

namespace vera {

/// Gives back what was freed in small blocks, whenever that is much: what is made of parts takes
/// the room of those that are done with, and does not stand beside it.
class FreedBlocks {
public:
    /// So many bytes were freed.
    void count(std::size_t bytes) {
        constexpr std::size_t much = std::size_t{3} << 20U;
        bytes_ += bytes;
        if (bytes_ < much)
            return;
        give_back_freed_memory();
        bytes_ = 0;
    }

private:
    std::size_t bytes_ = 0;
};

/// The parts one behind the other. With room for so many other pieces, which are merged in later.
VisiblePieces joined(std::vector<SeenPart> parts, std::size_t others = 0);

/// The pieces before, and the ones that were found, which are of other edges, by their edges: as if
/// all had been found together. Lights are those of both; what penetrates is that which was found.
/// Done in the room of the larger list, where that suffices.
VisiblePieces merged(VisiblePieces before, VisiblePieces found);

/// Leaves out the points that no piece has. The list keeps its room, but not the memory of what is
/// not used.
void forget_unused_points(VisiblePieces& list);

/// Makes one piece of those that follow each other on an edge, with the same beside them, where
/// nothing else ends. Where edges are parted so is a matter of how what is seen was found: what is
/// left is not.
void join_along_edges(VisiblePieces& list);

} // namespace vera
