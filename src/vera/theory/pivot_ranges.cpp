// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/pivot_ranges.h"

#include <algorithm>

namespace vera {

namespace {

/// Slopes at which the line through the pivot is at one of the side's ends.
struct SlopesOfEnds {
    Slope lower;
    Slope upper;
};

SlopesOfEnds slopes_of_ends(PlanePoint pivot, const PivotRanges::Side& side) {
    const std::int64_t run = std::int64_t{side.z} - pivot.x;
    return {
        Slope::of(std::int64_t{side.lower} - pivot.y, run),
        Slope::of(std::int64_t{side.upper} - pivot.y, run)};
}

/// In the pivot's own plane slopes change nothing.
bool holds_always(const DualLine& pivot, const PivotRanges::Side& side) {
    const bool above = pivot.is_upper ? pivot.end.y >= side.lower : pivot.end.y > side.lower;
    return above && pivot.end.y <= side.upper;
}

} // namespace

PivotRanges::PivotRanges(const DualLine& pivot, std::span<const Side> sides) {
    for (const Side& side : sides)
        if (side.z != pivot.end.x) {
            const SlopesOfEnds slopes = slopes_of_ends(pivot.end, side);
            ends_.push_back(slopes.lower);
            ends_.push_back(slopes.upper);
        }
    std::sort(ends_.begin(), ends_.end());
    ends_.erase(std::unique(ends_.begin(), ends_.end()), ends_.end());

    const auto at = [&](Slope slope) {
        const auto found = std::lower_bound(ends_.begin(), ends_.end(), slope);
        return static_cast<int>(2 * (found - ends_.begin()) + 1);
    };
    for (const Side& side : sides) {
        int first = 1;
        int last = 0;
        if (side.z == pivot.end.x) {
            if (holds_always(pivot, side)) {
                first = 0;
                last = static_cast<int>(place_count()) - 1;
            }
        } else {
            const SlopesOfEnds slopes = slopes_of_ends(pivot.end, side);
            const int inward = pivot.is_upper ? 0 : 1;
            // Behind the pivot a line of larger slope is lower.
            const bool ahead = side.z > pivot.end.x;
            first = ahead ? at(slopes.lower) + inward : at(slopes.upper);
            last = ahead ? at(slopes.upper) : at(slopes.lower) - inward;
        }
        ranges_.push_back(
            {static_cast<PivotPlace>(first), static_cast<PivotPlace>(std::max(last, 0))});
        if (last < first)
            ranges_.back() = {};
    }
}

PivotPlace PivotRanges::place_of(Slope slope, DualCounts& counts) const {
    const auto found = std::partition_point(ends_.begin(), ends_.end(), [&](Slope end) {
        ++counts.comparisons;
        return end < slope;
    });
    const bool is_end = found != ends_.end() && *found == slope;
    return static_cast<PivotPlace>(2 * (found - ends_.begin()) + (is_end ? 1 : 0));
}

} // namespace vera
