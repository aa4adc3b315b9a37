// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/region_outlines.h"

namespace vera {

RegionOutlines::RegionOutlines(const VisibleMap& map, const PictureSettings& picture)
    : map_(map)
    , width_(picture.width)
    , height_(picture.height) {
    for (std::size_t i = 0; i < map.rings.size(); ++i)
        if (i == 0 || map.rings[i].region != map.rings[i - 1].region)
            starts_.push_back(i);
    starts_.push_back(map.rings.size());
}

std::size_t RegionOutlines::corner_count(std::size_t region) const {
    std::size_t count = 0;
    for (const VisibleMap::Ring& ring : rings(region))
        count += ring.count;
    return count;
}

void RegionOutlines::add_ring(
    std::span<const std::uint32_t> vertices, FilledOutline& outline) const {
    std::vector<DrawingPoint>& points = outline.rings.emplace_back();
    points.reserve(vertices.size());
    for (const std::uint32_t vertex : vertices) {
        const RationalPoint& point = map_.vertices[vertex];
        points.push_back({point.x() * width_ / screen_size, point.y() * height_ / screen_size});
    }
}

void RegionOutlines::add_rings(std::size_t region, FilledOutline& outline) const {
    for (const VisibleMap::Ring& ring : rings(region))
        add_ring(map_.vertices_of(ring), outline);
}

} // namespace vera
