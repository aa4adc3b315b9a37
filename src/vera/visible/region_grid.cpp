// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/region_grid.h"

#include "vera/base/check.h"
#include "vera/base/long_loop.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vera {

namespace {

/// What doubles may be off, many times over; a border a bit beside a cell may be listed there.
constexpr double slack = 1.0 / 64;

} // namespace

std::size_t RegionGrid::column_of(double x) const {
    const double part = x / screen_size * static_cast<double>(side_);
    return static_cast<std::size_t>(std::clamp(part, 0.0, static_cast<double>(side_ - 1)));
}

template <typename Visit>
void RegionGrid::for_each_cell(std::uint32_t segment, const Visit& visit) const {
    const MapPoint& begin = segments_.begin(segment);
    const MapPoint& end = segments_.end(segment);
    const double height = screen_size / static_cast<double>(side_);
    const auto [low, high] = std::minmax(begin.y, end.y);
    const std::size_t last_row = column_of(high + slack);
    for (std::size_t row = column_of(low - slack); row <= last_row; ++row) {
        // The part of it that lies between the row's lower and upper border.
        const auto x_at = [&](double y) {
            const double part = (y - begin.y) / (end.y - begin.y);
            return begin.x + std::clamp(part, 0.0, 1.0) * (end.x - begin.x);
        };
        double from = begin.x;
        double to = end.x;
        if (high - low > slack) {
            const double bottom = static_cast<double>(row) * height;
            const auto [left, right] =
                std::minmax({x_at(bottom - slack), x_at(bottom + height + slack)});
            from = left;
            to = right;
        }
        const std::size_t last = column_of(to + slack);
        for (std::size_t column = column_of(from - slack); column <= last; ++column)
            visit(row * side_ + column);
    }
}

void RegionGrid::list_segments(const CancelFlag* cancel) {
    const auto count = static_cast<std::uint32_t>(segments_.segments.size());
    starts_.assign(side_ * side_ + 1, 0);
    const LongLoop loop(count, {}, cancel);
    for (std::uint32_t i = 0; i < count; ++i) {
        loop.turn(i);
        for_each_cell(i, [&](std::size_t cell) { ++starts_[cell + 1]; });
    }
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    listed_.resize(starts_.back());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    for (std::uint32_t i = 0; i < count; ++i) {
        loop.turn(i);
        for_each_cell(i, [&](std::size_t cell) { listed_[next[cell]++] = i; });
    }
}

/// Each from the one on its left, and the first of a row from outside.
void RegionGrid::find_known_points(const CancelFlag* cancel) {
    known_.resize(side_ * side_);
    LocatorSteps steps;
    std::vector<std::uint32_t> between;
    const double width = screen_size / static_cast<double>(side_);
    const LongLoop loop(known_.size(), {}, cancel);
    for (std::size_t cell = 0; cell < known_.size(); ++cell) {
        loop.turn(cell);
        const std::size_t row = cell / side_;
        const std::size_t column = cell % side_;
        // In the middle, or beside it where a border passes through that.
        MapPoint middle;
        double aside = 0;
        do {
            middle = map_point(
                (static_cast<double>(column) + 0.5) * width + aside,
                (static_cast<double>(row) + 0.5) * width + aside / 3);
            aside += 0x1p-18;
        } while (std::any_of(of_cell(cell).begin(), of_cell(cell).end(), [&](std::uint32_t i) {
            return is_on(i, middle);
        }));
        Known from = {map_point(RationalPoint{{-1, middle.exact.whole.y}}), no_region};
        between.assign(of_cell(cell).begin(), of_cell(cell).end());
        if (column > 0) {
            from = known_[cell - 1];
            const auto before = of_cell(cell - 1);
            between.insert(between.end(), before.begin(), before.end());
        }
        known_[cell] = {middle, region_after_walk(from, middle, between, steps)};
    }
    build_steps_ = listed_.size() + steps.comparisons;
}

RegionGrid::RegionGrid(MapSegments segments, const CancelFlag* cancel)
    : segments_(std::move(segments)) {
    constexpr double most = 4096;
    side_ = static_cast<std::size_t>(
        std::clamp(std::sqrt(static_cast<double>(segments_.segments.size())), 1.0, most));
    list_segments(cancel);
    find_known_points(cancel);
}

/// Whether the point lies on the segment, ends included.
bool RegionGrid::is_on(std::uint32_t segment, const MapPoint& point) const {
    return segments_.side(segment, point) == 0 && order(segments_.begin(segment), point) <= 0
        && order(point, segments_.end(segment)) <= 0;
}

/// Of two segments that a walk crosses, whether b is crossed after a: it lies on that side of a on
/// which the walk ends, or a lies on the other side of b.
bool RegionGrid::is_nearer(std::uint32_t a, std::uint32_t b, const MapPoint& to) const {
    const auto side_of = [&](std::uint32_t one, std::uint32_t other) {
        const int begin = segments_.side(one, segments_.begin(other));
        const int end = segments_.side(one, segments_.end(other));
        return begin * end < 0 ? 0 : begin + end;
    };
    if (const int of_b = side_of(a, b); of_b != 0)
        return of_b * segments_.side(a, to) > 0;
    return side_of(b, a) * segments_.side(b, to) < 0;
}

/// Neither end of the walk lies on a border. Where it passes through the end of one, it is taken to
/// do so a bit to the right of that.
std::uint32_t RegionGrid::region_after_walk(
    const Known& from,
    const MapPoint& to,
    std::span<const std::uint32_t> segments,
    LocatorSteps& steps) const {
    constexpr std::uint32_t none = ~std::uint32_t{0};
    std::uint32_t last = none;
    for (const std::uint32_t i : segments) {
        steps.comparisons += 2;
        if (segments_.side(i, from.point) * segments_.side(i, to) >= 0)
            continue;
        steps.comparisons += 2;
        const bool begins_left = side(from.point, to, segments_.begin(i)) >= 0;
        const bool ends_left = side(from.point, to, segments_.end(i)) >= 0;
        if (begins_left != ends_left && (last == none || is_nearer(last, i, to)))
            last = i;
    }
    if (last == none)
        return from.region;
    const MapSegment& segment = segments_.segments[last];
    return segments_.side(last, to) > 0 ? segment.above : segment.below;
}

std::uint32_t RegionGrid::region_at(const MapPoint& point, LocatorSteps& steps) const {
    ++steps.queries;
    const std::size_t cell = column_of(point.y) * side_ + column_of(point.x);
    const auto segments = of_cell(cell);
    for (const std::uint32_t i : segments) {
        ++steps.comparisons;
        if (is_on(i, point))
            return segments_.segments[i].above;
    }
    return region_after_walk(known_[cell], point, segments, steps);
}

std::size_t RegionGrid::memory() const {
    return segments_.bytes() + known_.capacity() * sizeof(Known)
        + starts_.capacity() * sizeof(std::size_t) + listed_.capacity() * sizeof(std::uint32_t);
}

} // namespace vera
