// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/part_sweeps.h"

#include "vera/base/long_loop.h"

#include <utility>

namespace vera {

void PartSweep::clear() {
    found_.points.clear();
    found_.pieces.clear();
    found_.unlit.clear();
    found_.penetrating.clear();
}

const VisiblePieces& PartSweep::followed(std::uint32_t edge) {
    clear();
    sweep_.follow(edge, found_);
    return found_;
}

SeenPart PartSweep::followed(EdgePart& part, const CancelFlag* cancel) {
    clear();
    const std::vector<ScreenEdges::Edge>& edges = raster_.edges.edges;
    std::size_t next = part.first;
    const auto follow_next = [&] {
        stop_if_raised(cancel); // one edge may be compared with all triangles
        if (raster_.is_followed(next))
            sweep_.follow(static_cast<std::uint32_t>(next), found_);
        ++next;
    };
    const VisiblePieces kept = part.kept.take();
    PieceCopy copy(kept, found_);
    for (std::size_t i = 0; i < kept.pieces.size(); ++i) {
        while (next < part.last && edges[next] < kept.pieces[i].edge)
            follow_next();
        copy.add(i);
    }
    while (next < part.last)
        follow_next();
    if (raster_.storage == PieceStorage::packed)
        number_points();
    return {found_, raster_.storage};
}

/// Leaves each point of what was found once.
void PartSweep::number_points() {
    points_.clear();
    numbers_.start(found_.points.size());
    number_of_.clear();
    for (const PackedPoint& point : found_.points)
        number_of_.push_back(numbers_.number(point));
    for (VisiblePiece& piece : found_.pieces) {
        piece.from = number_of_[piece.from];
        piece.to = number_of_[piece.to];
    }
    std::swap(found_.points, points_);
}

std::unique_ptr<PartSweep> PartSweeps::take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty())
        return std::make_unique<PartSweep>(raster_);
    std::unique_ptr<PartSweep> sweep = std::move(idle_.back());
    idle_.pop_back();
    return sweep;
}

void PartSweeps::give_back(std::unique_ptr<PartSweep> sweep) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(sweep));
}

CellCounts PartSweeps::counts() const {
    CellCounts counts;
    for (const std::unique_ptr<PartSweep>& sweep : idle_)
        counts.add_followed(sweep->counts());
    return counts;
}

} // namespace vera
