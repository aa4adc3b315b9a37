// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/side_projection.h"

#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

namespace vera {

RectanglesByZ::RectanglesByZ(std::span<const IsoRectangle> rectangles)
    : numbers_(rectangles.size()) {
    require_rectangles(rectangles);
    if (rectangles.size() > most_rectangles)
        throw std::invalid_argument(
            std::to_string(rectangles.size())
            + " rectangles are more than point location among "
              "the lines of their sides can number, and "
            + std::to_string(most_rectangles) + " the most: nested trees take more");
    std::iota(numbers_.begin(), numbers_.end(), 0U);
    std::stable_sort(numbers_.begin(), numbers_.end(), [&](std::uint32_t a, std::uint32_t b) {
        return rectangles[a].z < rectangles[b].z;
    });
    for (const std::uint32_t number : numbers_)
        z_.push_back(rectangles[number].z);
}

std::uint32_t RectanglesByZ::first_rank_from(std::int64_t z, DualCounts& counts) const {
    const auto found = std::partition_point(z_.begin(), z_.end(), [&](std::int32_t at) {
        ++counts.comparisons;
        return at < z;
    });
    return static_cast<std::uint32_t>(found - z_.begin());
}

std::uint32_t RectanglesByZ::first_rank_above(std::int64_t z, DualCounts& counts) const {
    return first_rank_from(z + 1, counts);
}

SideView side_view(const WholeRay& ray, SideProjection::Axis axis) {
    const std::size_t across = axis == SideProjection::Axis::x ? 0 : 1;
    SideView view;
    view.slope = Slope::of(ray.direction[across], ray.direction[2]);
    view.height = ray.origin[across] * view.slope.run - ray.origin[2] * view.slope.rise;
    return view;
}

void require_ray(const WholeRay& ray) {
    condition_half_planes(ray);
}

namespace {

std::vector<PivotRanges::Side> sides_of(
    std::span<const IsoRectangle> rectangles,
    const RectanglesByZ& order,
    SideProjection::Axis axis) {
    std::vector<PivotRanges::Side> sides;
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
        const IsoRectangle& rectangle = rectangles[order.number(rank)];
        if (axis == SideProjection::Axis::x)
            sides.push_back({rectangle.z, rectangle.lower_x, rectangle.upper_x});
        else
            sides.push_back({rectangle.z, rectangle.lower_y, rectangle.upper_y});
    }
    return sides;
}

/// Those of all sides, equal ones once.
std::vector<DualLine> lines_of(std::span<const PivotRanges::Side> sides) {
    std::vector<DualLine> lines;
    for (const PivotRanges::Side& side : sides) {
        lines.push_back({{side.z, side.lower}, false});
        lines.push_back({{side.z, side.upper}, true});
    }
    const auto comes_before = [](const DualLine& a, const DualLine& b) {
        if (a.end.x != b.end.x)
            return a.end.x < b.end.x;
        return a.end.y != b.end.y ? a.end.y < b.end.y : a.is_upper < b.is_upper;
    };
    std::sort(lines.begin(), lines.end(), comes_before);
    lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
    return lines;
}

} // namespace

SideProjection::SideProjection(
    std::span<const IsoRectangle> rectangles,
    const RectanglesByZ& order,
    Axis axis,
    const Progress& progress,
    const CancelFlag* cancel)
    : axis_(axis) {
    const std::vector<PivotRanges::Side> sides = sides_of(rectangles, order, axis);
    StageProgress stages(progress, 2);
    arrangement_ = DualArrangement(lines_of(sides), stages.next(1), cancel);
    const LongLoop loop(arrangement_.lines().size(), stages.next(1), cancel, 16);
    for (std::size_t i = 0; i < arrangement_.lines().size(); ++i) {
        loop.turn(i);
        pivots_.emplace_back(arrangement_.lines()[i], sides);
    }
    if (progress)
        progress(1);
}

std::optional<SideProjection::Pivot>
SideProjection::pivot(const WholeRay& ray, DualCounts& counts) const {
    const SideView view = side_view(ray, axis_);
    const auto line = arrangement_.first_above(view, counts);
    if (!line)
        return std::nullopt;
    return Pivot{*line, pivots_[*line].place_of(view.slope, counts)};
}

std::size_t SideProjection::bytes() const {
    std::size_t bytes = arrangement_.bytes() + pivots_.capacity() * sizeof(PivotRanges);
    for (const PivotRanges& pivot : pivots_)
        bytes += pivot.bytes();
    return bytes;
}

double SideProjection::bytes_forecast(std::size_t rectangles) {
    const auto n = static_cast<double>(rectangles);
    // Vectors that grow have up to twice the room.
    return DualArrangement::bytes_forecast(2 * rectangles)
        + 2 * 2 * n * (sizeof(PivotRanges) + n * (2 * sizeof(Slope) + sizeof(PivotRange)));
}

} // namespace vera
