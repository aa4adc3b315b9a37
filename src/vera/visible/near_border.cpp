// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/near_border.h"

#include <algorithm>
#include <cstddef>
#include <tuple>

namespace vera {

namespace {

constexpr double reach = 0.5; // pixels

double square(DrawingPoint way) {
    return way.x * way.x + way.y * way.y;
}

/// Of the distance to the side from a to b.
double squared_distance(DrawingPoint point, DrawingPoint a, DrawingPoint b) {
    const DrawingPoint side = {b.x - a.x, b.y - a.y};
    const DrawingPoint way = {point.x - a.x, point.y - a.y};
    const double length = square(side);
    const double part =
        length > 0 ? std::clamp((way.x * side.x + way.y * side.y) / length, 0.0, 1.0) : 0;
    return square({way.x - part * side.x, way.y - part * side.y});
}

} // namespace

NearBorder::NearBorder(const std::vector<BorderRing>& rings)
    : extent_(extent_of(rings)) {
    if (!(extent_.length() >= 0))
        return; // there are no sides
    rows_.resize(static_cast<std::size_t>(extent_.most.y - extent_.least.y) + 1);
    for (const BorderRing& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const DrawingPoint from = ring[i];
            const DrawingPoint to = ring[i + 1 == ring.size() ? 0 : i + 1];
            const auto [top, bottom] = std::minmax(from.y, to.y);
            for (std::size_t row = row_of(top - reach); row <= row_of(bottom + reach); ++row)
                add({from, to}, row);
        }
    for (Row& row : rows_)
        std::ranges::stable_sort(row.near, {}, &Near::column);
}

void NearBorder::add(const Side& side, std::size_t row) {
    const auto number = static_cast<std::uint32_t>(rows_[row].sides.size());
    rows_[row].sides.push_back(side);
    // The part of the side that is near to the row.
    const auto [from, to] = side;
    const double height = to.y - from.y;
    const double top = extent_.least.y + static_cast<double>(row) - reach;
    double first = 0;
    double last = 1;
    if (height != 0) {
        const double at_top = std::clamp((top - from.y) / height, 0.0, 1.0);
        const double at_bottom = std::clamp((top + 1 + 2 * reach - from.y) / height, 0.0, 1.0);
        std::tie(first, last) = std::minmax(at_top, at_bottom);
    }
    const auto [left, right] =
        std::minmax({from.x + first * (to.x - from.x), from.x + last * (to.x - from.x)});
    constexpr double slight = 0x1p-20; // more than what is rounded
    const std::int32_t end = column_of(right + reach + slight);
    for (std::int32_t column = column_of(left - reach - slight); column <= end; ++column)
        rows_[row].near.push_back({column, number});
}

bool NearBorder::includes(DrawingPoint point) const {
    if (!(extent_.length() > 2 * reach))
        return true;
    const Row& row = rows_[row_of(point.y)];
    const std::int32_t column = column_of(point.x);
    const auto first = std::ranges::lower_bound(row.near, column, {}, &Near::column);
    const auto last = std::ranges::upper_bound(row.near, column, {}, &Near::column);
    return std::any_of(first, last, [&](const Near& one) {
        const auto& [from, to] = row.sides[one.side];
        return squared_distance(point, from, to) < reach * reach;
    });
}

bool NearBorder::encloses(DrawingPoint point) const {
    if (rows_.empty())
        return false;
    const auto is_crossed = [&](const Side& side) {
        const auto [a, b] = side;
        if ((a.y <= point.y) == (b.y <= point.y))
            return false;
        return a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x) < point.x;
    };
    return std::ranges::count_if(rows_[row_of(point.y)].sides, is_crossed) % 2 == 1;
}

std::size_t NearBorder::row_of(double y) const {
    return static_cast<std::size_t>(
        std::clamp(y - extent_.least.y, 0.0, static_cast<double>(rows_.size() - 1)));
}

std::int32_t NearBorder::column_of(double x) const {
    return static_cast<std::int32_t>(
        std::clamp(x, extent_.least.x, extent_.most.x) - extent_.least.x);
}

} // namespace vera
