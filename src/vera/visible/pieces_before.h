// SPDX-License-Identifier: Apache-2.0
// What was seen without shadows, read in the order of the edges while these are followed anew.
#pragma once

#include "vera/visible/piece_lists.h"
#include "vera/visible/screen_scene.h"
#include "vera/visible/seen_parts.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// Goes through pieces that stand in parts, of which that which is read is there as a list.
class PartsReader {
public:
    explicit PartsReader(const std::vector<SeenPart>& parts)
        : parts_(parts) {}

    bool is_at_end() const { return part_ == parts_.size(); }

    /// The part that is read.
    std::size_t part() const { return part_; }

    const VisiblePieces& list() {
        if (!is_listed_) {
            list_ = parts_[part_].list();
            is_listed_ = true;
        }
        return list_;
    }

    /// To the next part.
    void go_on() {
        ++part_;
        is_listed_ = false;
        next = 0;
    }

    std::size_t next = 0; ///< of the pieces of the list

private:
    const std::vector<SeenPart>& parts_;
    std::size_t part_ = 0;
    VisiblePieces list_; ///< where is_listed_
    bool is_listed_ = false;
};

/// Tells what was seen beside each edge, for edges that come in ascending order.
class SeenBefore {
public:
    SeenBefore(const ScreenScene& screen, const std::vector<SeenPart>& before)
        : screen_(screen)
        , reader_(before) {}

    /// Calls visit(source) for each, perhaps more than once.
    template <typename Visit>
    void for_each_beside(ScreenEdges::Edge edge, const Visit& visit) {
        for (; !reader_.is_at_end(); reader_.go_on()) {
            const std::vector<VisiblePiece>& pieces = reader_.list().pieces;
            for (; reader_.next < pieces.size(); ++reader_.next) {
                const VisiblePiece& piece = pieces[reader_.next];
                if (edge < piece.edge)
                    return;
                if (piece.edge != edge)
                    continue;
                for (const std::uint32_t triangle : {piece.left, piece.right})
                    if (triangle != no_triangle)
                        visit(screen_.triangles[triangle].source);
            }
        }
    }

private:
    const ScreenScene& screen_;
    PartsReader reader_;
};

/// Takes out what stays as it was, some edges' pieces at a time.
class TakenBefore {
public:
    TakenBefore(std::vector<SeenPart>& before, PieceStorage storage)
        : before_(before)
        , storage_(storage)
        , reader_(before) {}

    /// Of edges that come in ascending order, the pieces of those that are not near a change; which
    /// are forgotten with the others up to the last of these edges.
    VisiblePieces
    take(std::span<const ScreenEdges::Edge> edges, std::span<const std::uint8_t> is_near_change);

private:
    std::vector<SeenPart>& before_;
    PieceStorage storage_;
    PartsReader reader_;
    FreedBlocks freed_;
};

} // namespace vera
