// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/triangle_order.h"

#include "vera/base/parallel.h"

#include <cstdlib>
#include <utility>

namespace vera {

namespace {

/// Where the side from a to b crosses a line, by how far off it these are.
NearnessPlace
crossing_of_side(ScreenPoint a, ScreenPoint b, std::int64_t side_a, std::int64_t side_b) {
    // Rounded but once, since these numbers have no more than 47 bits.
    const double part = static_cast<double>(side_a) / static_cast<double>(side_a - side_b);
    return {a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)};
}

} // namespace

std::vector<NearnessSlope> slopes_of(const ScreenScene& scene) {
    std::vector<NearnessSlope> slopes(scene.triangles.size());
    parallel_ranges(slopes.size(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            slopes[i] = nearness_slope(plane_of(scene, scene.triangles[i]));
    });
    return slopes;
}

Chord chord_in(const std::array<ScreenVertex, 3>& corners, ScreenPoint begin, ScreenPoint end) {
    const ScreenStep way = step(begin, end);
    const bool by_x = std::abs(way.x) >= std::abs(way.y);
    std::array<NearnessPlace, 2> places;
    std::size_t count = 0;
    std::array<std::int64_t, 3> sides;
    for (std::size_t i = 0; i < 3; ++i)
        sides[i] = orientation(begin, end, corners[i].point);
    for (std::size_t i = 0; i < 3 && count < 2; ++i) {
        const ScreenPoint here = corners[i].point;
        const ScreenPoint next = corners[(i + 1) % 3].point;
        const std::int64_t side_here = sides[i];
        const std::int64_t side_next = sides[(i + 1) % 3];
        if (side_here == 0)
            places[count++] = {static_cast<double>(here.x), static_cast<double>(here.y)};
        else if ((side_here < 0 && side_next > 0) || (side_here > 0 && side_next < 0))
            // The same whichever of the two triangles at that side is asked.
            places[count++] = here < next ? crossing_of_side(here, next, side_here, side_next)
                                          : crossing_of_side(next, here, side_next, side_here);
    }
    const auto at = [&](const NearnessPlace& place) { return by_x ? place.x : place.y; };
    if (at(places[1]) < at(places[0]))
        std::swap(places[0], places[1]);
    return {places[0], places[1], at(places[0]), at(places[1])};
}

FrontOrder triangle_order(
    const ScreenScene& scene,
    std::span<const NearnessSlope> slopes,
    std::uint32_t a,
    std::uint32_t b) {
    const ScreenTriangle& first = scene.triangles[a];
    const ScreenTriangle& second = scene.triangles[b];
    const FrontOrder found = order_in_overlap(
        {corners_of(scene, first), slopes[a]}, {corners_of(scene, second), slopes[b]});
    if (found != FrontOrder::coincident)
        return found;
    // The first of the text is in front.
    const bool is_first = first.source != second.source ? first.source < second.source : a < b;
    return is_first ? FrontOrder::first : FrontOrder::second;
}

FrontOrder triangle_order(
    const ScreenScene& scene,
    std::span<const NearnessSlope> slopes,
    const OnLine& a,
    const OnLine& b) {
    const std::array<NearnessPlace, 2> common = {
        a.chord.from_at > b.chord.from_at ? a.chord.from : b.chord.from,
        a.chord.to_at < b.chord.to_at ? a.chord.to : b.chord.to};
    const FrontOrder found = order_along(slopes[a.triangle], slopes[b.triangle], common);
    return found == FrontOrder::unknown ? triangle_order(scene, slopes, a.triangle, b.triangle)
                                        : found;
}

} // namespace vera
