// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/map_strips.h"

#include "vera/base/long_loop.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace vera {

namespace {

/// Ways with the source on their left go down at its right end, since y grows downward.
MapSide side_between(const RationalPoint& from, const RationalPoint& to, std::uint32_t source) {
    MapSide side = {from.x(), from.y(), to.x(), to.y(), source, true};
    if (std::tie(side.to_y, side.to_x) < std::tie(side.y, side.x)) {
        std::swap(side.x, side.to_x);
        std::swap(side.y, side.to_y);
        side.is_right_end = false;
    }
    return side;
}

} // namespace

MapStrips::MapStrips(const VisibleMap& map, double strip_height, const CancelFlag* cancel)
    : strip_height_(strip_height) {
    sides_.reserve(map.ring_vertices.size());
    const LongLoop rings(map.rings.size(), {}, cancel);
    for (std::size_t number = 0; number < map.rings.size(); ++number) {
        rings.turn(number);
        const VisibleMap::Ring& ring = map.rings[number];
        const auto vertices = map.vertices_of(ring);
        for (std::size_t i = 0; i < vertices.size(); ++i)
            sides_.push_back(side_between(
                map.vertices[vertices[i]],
                map.vertices[vertices[i + 1 == vertices.size() ? 0 : i + 1]],
                ring.source));
    }
    const auto strip_count = static_cast<std::size_t>(std::ceil(screen_size / strip_height));
    starts_.assign(strip_count + 1, 0);
    const auto for_each_strip = [&](const MapSide& side, const auto& visit) {
        const std::size_t last = strip_of(side.to_y);
        for (std::size_t strip = strip_of(side.y); strip <= last; ++strip)
            visit(strip);
    };
    const LongLoop loop(sides_.size(), {}, cancel);
    for (std::size_t i = 0; i < sides_.size(); ++i) {
        loop.turn(i);
        for_each_strip(sides_[i], [&](std::size_t strip) { ++starts_[strip + 1]; });
    }
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    listed_.resize(starts_.back());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    for (std::uint32_t i = 0; i < sides_.size(); ++i) {
        loop.turn(i);
        for_each_strip(sides_[i], [&](std::size_t strip) { listed_[next[strip]++] = i; });
    }
}

std::size_t MapStrips::strip_of(double y) const {
    return std::min(static_cast<std::size_t>(std::max(y, 0.0) / strip_height_), count() - 1);
}

} // namespace vera
