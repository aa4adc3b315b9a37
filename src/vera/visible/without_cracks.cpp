// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/without_cracks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vera {

namespace {

constexpr double crack_width = 0.02; ///< pixels: both sides rounded to a hundredth

/// Whether the way from a to b leads back along itself to c.
bool leads_back(const BorderPoint& a, const BorderPoint& b, const BorderPoint& c) {
    if (a.curve != no_curve || b.curve != no_curve)
        return false;
    if (b == c)
        return true;
    const DrawingPoint to_a = {a.x - b.x, a.y - b.y};
    const DrawingPoint to_c = {c.x - b.x, c.y - b.y};
    const double longer =
        std::sqrt(std::max(to_a.x * to_a.x + to_a.y * to_a.y, to_c.x * to_c.x + to_c.y * to_c.y));
    return to_a.x * to_c.x + to_a.y * to_c.y > 0
        && std::abs(to_a.x * to_c.y - to_a.y * to_c.x) <= crack_width * longer;
}

} // namespace

BorderRing without_cracks(const BorderRing& ring) {
    BorderRing kept;
    for (const BorderPoint& point : ring) {
        while (kept.size() > 1 && leads_back(kept[kept.size() - 2], kept.back(), point))
            kept.pop_back();
        kept.push_back(point);
    }
    // The ring may begin amid a crack.
    std::size_t first = 0;
    while (kept.size() - first > 2) {
        if (leads_back(kept[kept.size() - 2], kept.back(), kept[first]))
            kept.pop_back();
        else if (leads_back(kept.back(), kept[first], kept[first + 1]))
            ++first;
        else
            break;
    }
    if (kept.size() - first < 3 && std::ranges::all_of(kept, [](const BorderPoint& point) {
            return point.curve == no_curve;
        }))
        return {};
    return {kept.begin() + static_cast<std::ptrdiff_t>(first), kept.end()};
}

} // namespace vera
