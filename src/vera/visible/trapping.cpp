// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/trapping.h"

#include "vera/base/long_loop.h"
#include "vera/visible/seam_strips.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <span>

namespace vera {

std::vector<bool>
covering_whole(const RegionOutlines& regions, const Progress& progress, const CancelFlag* cancel) {
    constexpr std::size_t small = 16;
    constexpr double narrow = 4; // pixels, twice the strip's width
    std::vector<bool> result(regions.count());
    const LongLoop loop(regions.count(), progress, cancel);
    for (std::size_t number = 0; number < regions.count(); ++number) {
        loop.turn(number);
        double doubled_area = 0;
        double length = 0;
        for (const BorderRing& ring : regions.borders(number))
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const DrawingPoint& a = ring[i];
                const DrawingPoint& b = ring[i + 1 == ring.size() ? 0 : i + 1];
                const double x = b.x - a.x;
                const double y = b.y - a.y;
                doubled_area += (a.x - ring[0].x) * y - (a.y - ring[0].y) * x;
                length += std::sqrt(x * x + y * y);
            }
        result[number] =
            regions.corner_count(number) <= small || doubled_area < narrow / 2 * length;
    }
    return result;
}

void cover_seams(
    const RegionOutlines& regions,
    const std::vector<bool>& is_covering_whole,
    std::size_t number,
    PaintedRegion& region) {
    const auto own = regions.rings(number);
    std::vector<std::uint32_t> below;
    for (std::size_t i = 0; i < own.size(); ++i) {
        const BorderRing& points = region.rings[i];
        for (std::size_t j = 0; j < points.size(); ++j) {
            const std::uint32_t across = regions.map().ring_across[own[i].first + j];
            if (across == no_region || across <= number)
                continue;
            if (!is_covering_whole[across]) {
                region.outline.seams.push_back(
                    {points[j], points[j + 1 == points.size() ? 0 : j + 1]});
            } else if (std::find(below.begin(), below.end(), across) == below.end()) {
                below.push_back(across);
                std::ranges::move(regions.borders(across), std::back_inserter(region.below));
            }
        }
    }
}

void cover_seams_closely(const RegionOutlines& regions, std::size_t number, PaintedRegion& region) {
    constexpr std::size_t most_corners = 1024; // of a neighbour: else strips take too long
    const auto own = regions.rings(number);
    for (std::size_t i = 0; i < own.size(); ++i) {
        BorderRing points = region.rings[i];
        points.push_back(points.front());
        const auto across = [&](std::size_t side) {
            return regions.map().ring_across[own[i].first + side];
        };
        for (std::size_t side = 0, end = 0; side + 1 < points.size(); side = end) {
            for (end = side + 1; end + 1 < points.size() && across(end) == across(side);)
                ++end;
            if (across(side) == no_region || across(side) <= number)
                continue;
            const std::span border = std::span(points).subspan(side, end - side + 1);
            if (regions.corner_count(across(side)) > most_corners) {
                region.outline.seams.emplace_back(border.begin(), border.end());
                continue;
            }
            std::vector<BorderRing> strips = seam_strips(border, regions.borders(across(side)));
            reach_back(border, regions.curves(), strips);
            std::ranges::move(strips, std::back_inserter(region.below));
        }
    }
}

} // namespace vera
