// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/without_cracks.h"

#include "vera/drawing/elliptic_arc.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>

namespace vera {

namespace {

constexpr double crack_width = 0.02; ///< pixels: both sides rounded to a hundredth

/// Also what goes along a curve, if it is that short.
bool is_straight(const BorderPoint& from, const BorderPoint& to) {
    return from.curve == no_curve || distance(from, to) <= crack_width;
}

/// Whether the way from a to b leads back along itself to c.
bool leads_back(const BorderPoint& a, const BorderPoint& b, const BorderPoint& c) {
    if (!is_straight(a, b) || !is_straight(b, c))
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

/// How many of the last points are where the way turns round before it leads back to that point:
/// none, one, or two at the end of a crack as wide there as anywhere.
std::size_t turning_points(const std::deque<BorderPoint>& way, const BorderPoint& next) {
    const std::size_t count = way.size();
    if (count > 1 && leads_back(way[count - 2], way[count - 1], next))
        return 1;
    if (count < 3 || !is_straight(way[count - 3], way[count - 2]))
        return 0;
    const BorderPoint& end = way[count - 1];
    BorderPoint begin = way[count - 3];
    begin.curve = no_curve;
    return distance(way[count - 2], end) <= crack_width && leads_back(begin, end, next) ? 2 : 0;
}

void go_on(std::deque<BorderPoint>& way, const BorderPoint& next) {
    while (const std::size_t turning = turning_points(way, next)) {
        way.resize(way.size() - turning);
        way.back().curve = no_curve;
    }
    way.push_back(next);
}

} // namespace

BorderRing without_cracks(const BorderRing& ring) {
    std::deque<BorderPoint> kept;
    for (const BorderPoint& point : ring)
        go_on(kept, point);
    // The ring may begin amid a crack: the way goes on along its first points.
    constexpr std::size_t enough = 3;
    std::size_t again = 0;
    while (again < enough && kept.size() > 2) {
        const BorderPoint first = kept.front();
        kept.pop_front();
        const std::size_t rest = kept.size();
        go_on(kept, first);
        again = kept.size() > rest ? again + 1 : 0;
    }
    if (kept.empty())
        return {};
    if (kept.size() < 3 && is_straight(kept.front(), kept.back())
        && is_straight(kept.back(), kept.front()))
        return {};
    const auto begin = kept.end() - static_cast<std::ptrdiff_t>(std::min(again, kept.size()));
    std::rotate(kept.begin(), begin, kept.end());
    return {kept.begin(), kept.end()};
}

} // namespace vera
