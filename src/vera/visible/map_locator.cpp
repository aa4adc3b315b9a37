// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/map_locator.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace vera {

namespace {

/// As high as that a strip and the strips that a side touches are few alike.
double strip_height(const VisibleMap& map) {
    constexpr double most = 4096;
    const double wanted = 2 * std::sqrt(static_cast<double>(map.ring_vertices.size()));
    return screen_size / std::clamp(std::floor(wanted), 1.0, most);
}

/// The square of how far the segment is from the origin.
double distance_squared(double x, double y, double to_x, double to_y) {
    const double step_x = to_x - x;
    const double step_y = to_y - y;
    const double length_squared = step_x * step_x + step_y * step_y;
    const double part =
        length_squared > 0 ? std::clamp(-(x * step_x + y * step_y) / length_squared, 0.0, 1.0) : 0;
    const double near_x = x + part * step_x;
    const double near_y = y + part * step_y;
    return near_x * near_x + near_y * near_y;
}

} // namespace

MapLocator::MapLocator(const VisibleMap& map, const CancelFlag* cancel)
    : strips_(map, strip_height(map), cancel) {}

MapPlace MapLocator::at(double x, double y) const {
    MapPlace place;
    for_each_source(
        strips_, strips_.of_strip(strips_.strip_of(y)), [&](std::uint32_t source, auto sides) {
            int turns = 0;
            for (const std::uint32_t number : sides)
                if (const MapSide& side = strips_[number]; side.crosses(y) && side.x_at(y) > x)
                    turns += side.is_right_end ? 1 : -1;
            if (turns == 0)
                return;
            place.is_sound = turns == 1 && place.source == no_source;
            place.source = std::min(place.source, source);
        });
    return place;
}

bool MapLocator::has_side_near(double x, double y, double reach_x, double reach_y) const {
    const std::size_t last = strips_.strip_of(y + reach_y);
    for (std::size_t strip = strips_.strip_of(y - reach_y); strip <= last; ++strip)
        for (const std::uint32_t number : strips_.of_strip(strip)) {
            const MapSide& side = strips_[number];
            if (distance_squared(
                    (side.x - x) / reach_x,
                    (side.y - y) / reach_y,
                    (side.to_x - x) / reach_x,
                    (side.to_y - y) / reach_y)
                <= 1)
                return true;
        }
    return false;
}

} // namespace vera
