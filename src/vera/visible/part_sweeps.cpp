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

PackedPieces PartSweep::followed(std::size_t first, std::size_t last, const CancelFlag* cancel) {
    clear();
    for (std::size_t i = first; i < last; ++i) {
        stop_if_raised(cancel); // one edge may be compared with all triangles
        if (raster_.is_followed(i))
            sweep_.follow(static_cast<std::uint32_t>(i), found_);
    }
    points_.clear();
    numbers_.start(found_.points.size());
    for (VisiblePiece& piece : found_.pieces) {
        piece.from = numbers_.number(found_.points[piece.from]);
        piece.to = numbers_.number(found_.points[piece.to]);
    }
    std::swap(found_.points, points_);
    return PackedPieces(found_);
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
