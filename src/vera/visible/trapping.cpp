// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/trapping.h"

#include "vera/base/long_loop.h"
#include "vera/visible/seam_strips.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <span>
#include <unordered_set>

namespace vera {

namespace {

/// Of a neighbour: else strips take too long, and what goes on below the whole of a floor in the
/// shadow of many leaves, at each of these, takes far more than all that is drawn.
constexpr std::size_t most_corners = 1024;

/// Calls visit(border, what is seen across) for each part of the region's rings beyond which one
/// that is painted later lies: consecutive points.
template <typename Visit>
void for_each_border_with_later(
    const RegionOutlines& regions,
    std::size_t number,
    const std::vector<BorderRing>& rings,
    const Visit& visit) {
    const auto own = regions.rings(number);
    for (std::size_t i = 0; i < own.size(); ++i) {
        BorderRing points = rings[i];
        std::size_t begin = 0;
        const auto across = [&, count = points.size()](std::size_t side) {
            return regions.map().ring_across[own[i].first + (begin + side) % count];
        };
        // The ring may begin amid the border with one neighbour.
        while (begin < points.size() && across(0) == across(points.size() - 1))
            ++begin;
        begin %= points.size();
        std::rotate(
            points.begin(), points.begin() + static_cast<std::ptrdiff_t>(begin), points.end());
        points.push_back(points.front());
        for (std::size_t side = 0, end = 0; side + 1 < points.size(); side = end) {
            for (end = side + 1; end + 1 < points.size() && across(end) == across(side);)
                ++end;
            if (across(side) != no_region && across(side) > number)
                visit(std::span(points).subspan(side, end - side + 1), across(side));
        }
    }
}

/// Lets the region go on below that neighbour close to the border that they have in common.
void go_on_closely(
    const RegionOutlines& regions,
    std::span<const BorderPoint> border,
    std::size_t neighbour,
    PaintedRegion& region) {
    std::vector<BorderRing> strips = seam_strips(border, regions.borders(neighbour));
    reach_back(border, regions.curves(), strips);
    std::ranges::move(strips, std::back_inserter(region.below));
}

/// Whether is(what is seen across) of a part of the region's border beyond which one that is
/// painted later lies.
template <typename Is>
bool is_any_later(const RegionOutlines& regions, std::size_t number, const Is& is) {
    for (const VisibleMap::Ring& ring : regions.rings(number))
        for (std::size_t i = ring.first; i < ring.first + ring.count; ++i)
            if (const std::uint32_t across = regions.map().ring_across[i];
                across != no_region && across > number && is(across))
                return true;
    return false;
}

bool can_have_strips(const RegionOutlines& regions, std::uint32_t across) {
    return regions.corner_count(across) <= most_corners;
}

/// Whether a region may go on below the whole of that one.
bool is_small(const RegionOutlines& regions, std::span<const float> widths, std::uint32_t across) {
    constexpr std::size_t few = 16;
    constexpr float narrow = 2; // pixels: where strips of one come near the other side
    return regions.corner_count(across) <= few
        || (widths[across] < narrow && can_have_strips(regions, across));
}

/// Whether a seam's line along the border of one that is not small stays within the region.
bool has_room_for_seam(
    const RegionOutlines& regions,
    std::span<const float> widths,
    std::size_t number,
    std::uint32_t across) {
    constexpr float narrow = 1; // pixels: where half of a seam's line comes near the other side
    return widths[number] >= narrow || !can_have_strips(regions, across);
}

/// Whether one may shine through at the other's far border without being seen.
bool are_alike(DrawingColor a, DrawingColor b) {
    constexpr int alike = 24; // of 255: a quarter of it shines through at most
    return std::abs(a.r - b.r) <= alike && std::abs(a.g - b.g) <= alike
        && std::abs(a.b - b.b) <= alike;
}

} // namespace

std::vector<float> widths_of_regions(
    const RegionOutlines& regions, const Progress& progress, const CancelFlag* cancel) {
    std::vector<float> widths(regions.count());
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
        widths[number] = length > 0 ? static_cast<float>(doubled_area / length) : 0;
    }
    return widths;
}

void cover_seams(
    const RegionOutlines& regions,
    std::span<const float> widths,
    std::span<const DrawingColor> colors,
    std::size_t number,
    PaintedRegion& region) {
    std::unordered_set<std::uint32_t> below; // as many as small areas lie within a large one
    const auto cover = [&](std::span<const BorderPoint> border, std::uint32_t across) {
        if (!is_small(regions, widths, across)) {
            if (has_room_for_seam(regions, widths, number, across))
                region.outline.seams.emplace_back(border.begin(), border.end());
            else
                go_on_closely(regions, border, across, region);
        } else if (!are_alike(colors[number], colors[across])) {
            go_on_closely(regions, border, across, region);
        } else if (below.insert(across).second) {
            std::ranges::move(regions.borders(across), std::back_inserter(region.below));
        }
    };
    for_each_border_with_later(regions, number, region.rings, cover);
}

bool has_seams(const RegionOutlines& regions, std::span<const float> widths, std::size_t number) {
    return is_any_later(regions, number, [&](std::uint32_t across) {
        return !is_small(regions, widths, across)
            && has_room_for_seam(regions, widths, number, across);
    });
}

void cover_seams_closely(const RegionOutlines& regions, std::size_t number, PaintedRegion& region) {
    const auto cover = [&](std::span<const BorderPoint> border, std::uint32_t across) {
        if (can_have_strips(regions, across))
            go_on_closely(regions, border, across, region);
        else
            region.outline.seams.emplace_back(border.begin(), border.end());
    };
    for_each_border_with_later(regions, number, region.rings, cover);
}

bool has_seams_closely(const RegionOutlines& regions, std::size_t number) {
    return is_any_later(
        regions, number, [&](std::uint32_t across) { return !can_have_strips(regions, across); });
}

} // namespace vera
