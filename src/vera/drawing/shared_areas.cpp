// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/drawing.h"

namespace vera {

FilledOutline outline_of(const SharedAreas& areas, std::size_t number) {
    const auto begin_of = [](const std::vector<std::uint32_t>& ends, std::size_t i) {
        return i == 0 ? 0 : ends[i - 1];
    };
    FilledOutline outline;
    outline.color = areas.colors[number];
    const std::uint32_t end = areas.area_ends[number];
    outline.rings.reserve(end - begin_of(areas.area_ends, number));
    for (std::uint32_t ring = begin_of(areas.area_ends, number); ring < end; ++ring) {
        std::vector<DrawingPoint>& points = outline.rings.emplace_back();
        const std::uint32_t first = begin_of(areas.ring_ends, ring);
        points.reserve(areas.ring_ends[ring] - first);
        for (std::uint32_t i = first; i < areas.ring_ends[ring]; ++i)
            points.push_back(areas.places[areas.corners[i]]);
    }
    return outline;
}

} // namespace vera
