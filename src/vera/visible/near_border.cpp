// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/near_border.h"

#include <algorithm>
#include <cstddef>

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
    sides_.resize(static_cast<std::size_t>(extent_.most.y - extent_.least.y) + 1);
    for (const BorderRing& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const DrawingPoint from = ring[i];
            const DrawingPoint to = ring[i + 1 == ring.size() ? 0 : i + 1];
            const auto [top, bottom] = std::minmax(from.y, to.y);
            for (std::size_t row = row_of(top - reach); row <= row_of(bottom + reach); ++row)
                sides_[row].emplace_back(from, to);
        }
}

bool NearBorder::includes(DrawingPoint point) const {
    if (!(extent_.length() > 2 * reach))
        return true;
    return std::ranges::any_of(sides_[row_of(point.y)], [&](const Side& side) {
        return squared_distance(point, side.first, side.second) < reach * reach;
    });
}

bool NearBorder::encloses(DrawingPoint point) const {
    if (sides_.empty())
        return false;
    const auto is_crossed = [&](const Side& side) {
        const auto [a, b] = side;
        if ((a.y <= point.y) == (b.y <= point.y))
            return false;
        return a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x) < point.x;
    };
    return std::ranges::count_if(sides_[row_of(point.y)], is_crossed) % 2 == 1;
}

std::size_t NearBorder::row_of(double y) const {
    return static_cast<std::size_t>(
        std::clamp(y - extent_.least.y, 0.0, static_cast<double>(sides_.size() - 1)));
}

} // namespace vera
