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
        FilledOutline outline;
        regions.add_rings(number, outline);
        double doubled_area = 0;
        double length = 0;
        for (const std::vector<DrawingPoint>& ring : outline.rings)
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
    std::size_t region,
    FilledOutline& outline) {
    const auto own = regions.rings(region);
    std::vector<std::uint32_t> below;
    const std::size_t own_rings = outline.rings.size();
    for (std::size_t i = 0; i < own_rings; ++i) {
        const std::vector<DrawingPoint> points = outline.rings[i];
        for (std::size_t j = 0; j < points.size(); ++j) {
            const std::uint32_t across = regions.map().ring_across[own[i].first + j];
            if (across == no_region || across <= region)
                continue;
            if (!is_covering_whole[across]) {
                outline.seams.push_back({points[j], points[j + 1 == points.size() ? 0 : j + 1]});
            } else if (std::find(below.begin(), below.end(), across) == below.end()) {
                below.push_back(across);
                regions.add_rings(across, outline);
            }
        }
    }
}

void cover_seams_closely(
    const RegionOutlines& regions, std::size_t region, FilledOutline& outline) {
    constexpr std::size_t most_corners = 1024; // of a neighbour: else strips take too long
    const auto own = regions.rings(region);
    const std::size_t own_rings = outline.rings.size();
    for (std::size_t i = 0; i < own_rings; ++i) {
        std::vector<DrawingPoint> points = outline.rings[i];
        points.push_back(points.front());
        const auto across = [&](std::size_t side) {
            return regions.map().ring_across[own[i].first + side];
        };
        for (std::size_t side = 0, end = 0; side + 1 < points.size(); side = end) {
            for (end = side + 1; end + 1 < points.size() && across(end) == across(side);)
                ++end;
            if (across(side) == no_region || across(side) <= region)
                continue;
            const std::span border = std::span(points).subspan(side, end - side + 1);
            if (regions.corner_count(across(side)) > most_corners) {
                outline.seams.emplace_back(border.begin(), border.end());
                continue;
            }
            FilledOutline neighbour;
            regions.add_rings(across(side), neighbour);
            std::ranges::move(
                seam_strips(border, neighbour.rings), std::back_inserter(outline.rings));
        }
    }
}

} // namespace vera
