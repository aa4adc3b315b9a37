// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/pieces_before.h"

#include <utility>

namespace vera {

VisiblePieces TakenBefore::take(
    std::span<const ScreenEdges::Edge> edges, std::span<const std::uint8_t> is_near_change) {
    std::vector<SeenPart> all;
    for (std::size_t edge = 0; !reader_.is_at_end() && !edges.empty(); reader_.go_on()) {
        const VisiblePieces& list = reader_.list();
        VisiblePieces taken;
        PieceCopy copy(list, taken);
        for (; reader_.next < list.pieces.size(); ++reader_.next) {
            const ScreenEdges::Edge here = list.pieces[reader_.next].edge;
            if (edges.back() < here)
                break;
            while (edges[edge] < here)
                ++edge;
            if (is_near_change[edge] == 0)
                copy.add(reader_.next);
        }
        if (!taken.pieces.empty())
            all.emplace_back(std::move(taken), storage_);
        if (reader_.next < list.pieces.size())
            break;
        freed_.count(before_[reader_.part()].room());
        before_[reader_.part()] = {};
    }
    return joined(std::move(all));
}

} // namespace vera
