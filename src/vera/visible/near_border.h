// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/visible/border_ring.h"
#include "vera/visible/region_samples.h"

#include <utility>
#include <vector>

namespace vera {

/// The points nearer than half a pixel to the border of a region, and those in it, found by the
/// rows of pixels that its sides come near to.
class NearBorder {
public:
    explicit NearBorder(const std::vector<BorderRing>& rings);

    bool includes(DrawingPoint point) const;

    /// Whether the point lies in the region: its sides are crossed an odd number of times on the
    /// way there from the left.
    bool encloses(DrawingPoint point) const;

private:
    using Side = std::pair<DrawingPoint, DrawingPoint>;

    std::size_t row_of(double y) const;

    Extent extent_;
    std::vector<std::vector<Side>> sides_; ///< of each row
};

} // namespace vera
