// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/theory/dual_arrangement.h"
#include "vera/theory/iso_rectangle.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// Places among the ends of ranges: 2i + 1 is at the end of number i, and 2i between the one before
/// and it.
using PivotPlace = std::uint16_t;

/// From the first place to the last; empty where the last one is smaller.
struct PivotRange {
    PivotPlace first = 1;
    PivotPlace last = 0;

    bool is_empty() const { return last < first; }

    bool contains(PivotPlace place) const { return first <= place && place <= last; }
};

/// A line that has risen until it met the end of a side turns about that end with its slope. It
/// passes another rectangle, seen from the side, while its slope is within a range. Of a lower end
/// the line is below by less than anything, so that the lower ends of sides no longer belong to
/// them; through an upper one it goes. So it passes the same sides as before it rose.
class PivotRanges {
public:
    /// The sides of rectangles: `lower` and `upper` at their z.
    struct Side {
        std::int32_t z = 0;
        std::int32_t lower = 0;
        std::int32_t upper = 0;
    };

    PivotRanges() = default;

    PivotRanges(const DualLine& pivot, std::span<const Side> sides);

    /// Of a line with that slope through the pivot. Takes a search.
    PivotPlace place_of(Slope slope, DualCounts& counts) const;

    /// Of each side.
    std::span<const PivotRange> ranges() const { return ranges_; }

    std::size_t place_count() const { return 2 * ends_.size() + 1; }

    std::size_t bytes() const {
        return ends_.capacity() * sizeof(Slope) + ranges_.capacity() * sizeof(PivotRange);
    }

private:
    std::vector<Slope> ends_; ///< ascending, none twice
    std::vector<PivotRange> ranges_;
};

} // namespace vera
