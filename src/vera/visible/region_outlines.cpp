// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/region_outlines.h"

#include <utility>

namespace vera {

RegionOutlines::RegionOutlines(const VisibleMap& map, DrawnBorders borders)
    : map_(map)
    , borders_(std::move(borders)) {
    for (std::size_t i = 0; i < map.rings.size(); ++i)
        if (i == 0 || map.rings[i].region != map.rings[i - 1].region)
            starts_.push_back(i);
    starts_.push_back(map.rings.size());
}

std::size_t RegionOutlines::corner_count(std::size_t region) const {
    const VisibleMap::Ring& first = map_.rings[starts_[region]];
    const VisibleMap::Ring& last = map_.rings[starts_[region + 1] - 1];
    return last.first + last.count - first.first; // one ring's behind the other's
}

std::vector<BorderRing> RegionOutlines::borders(std::size_t region) const {
    std::vector<BorderRing> borders;
    borders.reserve(rings(region).size());
    for (const VisibleMap::Ring& ring : rings(region))
        borders.push_back(borders_.ring(map_, ring));
    return borders;
}

BorderRing RegionOutlines::border(std::span<const std::uint32_t> sides) const {
    BorderRing way;
    way.reserve(sides.size());
    for (const std::uint32_t side : sides)
        way.push_back(borders_.point(map_, side));
    return way;
}

} // namespace vera
