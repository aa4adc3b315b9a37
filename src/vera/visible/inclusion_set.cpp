// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/inclusion_set.h"

#include "vera/base/check.h"

#include <algorithm>

namespace vera {

void InclusionSet::go_up(
    std::span<const SweepSegments::Border> borders, const std::array<NearnessPlace, 2>& places) {
    // By membership, never by comparison: what is in no order is found all the same.
    for (const SweepSegments::Border& border : borders) {
        if (border.is_above)
            continue;
        const auto found = std::find(triangles_.begin(), triangles_.end(), border.triangle);
        VERA_CHECK(found != triangles_.end());
        changes_.push_back(
            {static_cast<std::uint32_t>(found - triangles_.begin()), border.triangle, false});
        counts_.moved += static_cast<std::uint64_t>(triangles_.end() - found);
        triangles_.erase(found);
    }
    for (const SweepSegments::Border& border : borders) {
        if (!border.is_above)
            continue;
        const auto behind =
            std::partition_point(triangles_.begin(), triangles_.end(), [&](std::uint32_t triangle) {
                ++counts_.depth_orders;
                return is_before(triangle, border.triangle, places);
            });
        ++counts_.insertions;
        changes_.push_back(
            {static_cast<std::uint32_t>(behind - triangles_.begin()), border.triangle, true});
        counts_.moved += static_cast<std::uint64_t>(triangles_.end() - behind);
        triangles_.insert(behind, border.triangle);
    }
    counts_.largest_set = std::max<std::uint64_t>(counts_.largest_set, triangles_.size());
}

bool InclusionSet::is_before(
    std::uint32_t a, std::uint32_t b, const std::array<NearnessPlace, 2>& places) const {
    const FrontOrder here = order_along(slopes_[a], slopes_[b], places);
    return (here == FrontOrder::unknown ? triangle_order(scene_, slopes_, a, b) : here)
        != FrontOrder::second;
}

void InclusionSet::take_back(std::size_t changes) {
    for (; changes_.size() > changes; changes_.pop_back()) {
        const Change& change = changes_.back();
        const auto at = triangles_.begin() + change.position;
        counts_.moved += static_cast<std::uint64_t>(triangles_.end() - at);
        if (change.came_in)
            triangles_.erase(at);
        else
            triangles_.insert(at, change.triangle);
    }
}

} // namespace vera
