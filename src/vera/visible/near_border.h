// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/visible/border_ring.h"
#include "vera/visible/region_samples.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace vera {

/// The points nearer than half a pixel to the border of a region, found by the pixels that its
/// sides come near to, and those in it, found by the rows of these.
class NearBorder {
public:
    explicit NearBorder(const std::vector<BorderRing>& rings);

    bool includes(DrawingPoint point) const;

    /// Whether the point lies in the region: its sides are crossed an odd number of times on the
    /// way there from the left.
    bool encloses(DrawingPoint point) const;

private:
    using Side = std::pair<DrawingPoint, DrawingPoint>;

    /// A side comes near to the pixel of that column.
    struct Near {
        std::int32_t column = 0;
        std::uint32_t side = 0; ///< of the row
    };

    struct Row {
        std::vector<Side> sides;
        std::vector<Near> near; ///< by column
    };

    void add(const Side& side, std::size_t row);
    std::size_t row_of(double y) const;
    std::int32_t column_of(double x) const;

    Extent extent_;
    std::vector<Row> rows_;
};

} // namespace vera
