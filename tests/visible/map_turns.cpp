// SPDX-License-Identifier: Apache-2.0
#include "visible/map_turns.h"

namespace vera::testing {

std::map<std::uint32_t, int> turns_about(const VisibleMap& map, double x, double y) {
    std::map<std::uint32_t, int> turns;
    for (const VisibleMap::Ring& ring : map.rings) {
        const auto vertices = map.vertices_of(ring);
        int of_ring = 0;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const RationalPoint& a = map.vertices[vertices[i]];
            const RationalPoint& b = map.vertices[vertices[(i + 1) % vertices.size()]];
            const double side = (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
            if (a.y() <= y && b.y() > y && side > 0)
                ++of_ring;
            else if (a.y() > y && b.y() <= y && side < 0)
                --of_ring;
        }
        if (of_ring != 0 && (turns[ring.region] += of_ring) == 0)
            turns.erase(ring.region);
    }
    return turns;
}

double area_of(const VisibleMap& map) {
    double area = 0;
    for (const VisibleMap::Ring& ring : map.rings)
        area += 0.5 * doubled_area(map, ring);
    return area;
}

} // namespace vera::testing
