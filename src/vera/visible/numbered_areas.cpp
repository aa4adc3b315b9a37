// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/numbered_areas.h"

#include "vera/base/free_room.h"
#include "vera/base/long_loop.h"
#include "vera/visible/outline_curves.h"

#include <cstddef>
#include <utility>

namespace vera {

DrawingColor color_of_number(std::uint64_t number) {
    const auto byte = [&](unsigned shift) {
        return static_cast<std::uint8_t>(number >> shift & 0xffU);
    };
    return {byte(16), byte(8), byte(0)};
}

SharedAreas numbered_areas(
    VisibleMap map,
    std::span<const std::uint64_t> primitives,
    const PictureSettings& picture,
    const CancelFlag* cancel) {
    SharedAreas areas;
    free_room(map.ring_across);
    areas.places.resize(map.vertices.size());
    parallel_ranges(areas.places.size(), 4096, [&](std::size_t first, std::size_t last) {
        stop_if_raised(cancel);
        for (std::size_t i = first; i < last; ++i)
            areas.places[i] = in_pixels(picture, map.vertices[i]);
    });
    free_room(map.vertices);
    areas.corners = std::move(map.ring_vertices);
    areas.ring_ends.reserve(map.rings.size());
    areas.area_ends.reserve(map.regions.size());
    areas.colors.reserve(map.regions.size());
    const LongLoop loop(map.rings.size(), {}, cancel);
    for (std::size_t i = 0; i < map.rings.size(); ++i) {
        loop.turn(i);
        const VisibleMap::Ring& ring = map.rings[i];
        if (i == 0 || ring.region != map.rings[i - 1].region) {
            areas.colors.push_back(color_of_number(primitives[ring.source] + 1));
            areas.area_ends.push_back(static_cast<std::uint32_t>(i));
        }
        areas.ring_ends.push_back(static_cast<std::uint32_t>(ring.first + ring.count));
        areas.area_ends.back() = static_cast<std::uint32_t>(i + 1);
    }
    return areas;
}

} // namespace vera
