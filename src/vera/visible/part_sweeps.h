// SPDX-License-Identifier: Apache-2.0
// What each thread follows edges with, part by part.
#pragma once

#include "vera/base/parallel.h"
#include "vera/visible/cell_counts.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/edge_sweep.h"
#include "vera/visible/point_numbers.h"
#include "vera/visible/seen_parts.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace vera {

/// Follows parts of the edges, one after the other in the same room.
class PartSweep {
public:
    explicit PartSweep(const CellRaster& raster)
        : raster_(raster)
        , sweep_(raster)
        , numbers_(points_, 0) {}

    /// What is found of one edge, until another is followed.
    const VisiblePieces& followed(std::uint32_t edge);

    /// What is found of those of the edges that are near what was changed, and the kept pieces,
    /// which it takes. Throws Cancelled.
    SeenPart followed(EdgePart& part, const CancelFlag* cancel);

    /// Of all edges that it followed.
    CellCounts counts() const { return sweep_.counts(); }

private:
    void clear();
    void number_points();

    const CellRaster& raster_;
    EdgeSweep sweep_;
    VisiblePieces found_;
    std::vector<PackedPoint> points_; ///< those of found_, each once, in whose place they come
    PointNumbers numbers_;
    std::vector<std::uint32_t> number_of_; ///< of the points of found_ that are not yet there once
};

/// Lends one PartSweep to each thread that works.
class PartSweeps {
public:
    explicit PartSweeps(const CellRaster& raster)
        : raster_(raster) {}

    std::unique_ptr<PartSweep> take();
    void give_back(std::unique_ptr<PartSweep> sweep);

    /// Of all edges that were followed, when all have been given back.
    CellCounts counts() const;

private:
    const CellRaster& raster_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<PartSweep>> idle_;
};

} // namespace vera
