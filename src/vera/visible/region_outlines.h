// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/visible/border_ring.h"
#include "vera/visible/drawn_borders.h"
#include "vera/visible/visible_map.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// The regions of a map, by their numbers, as outlines in pixels. The map must outlive it.
class RegionOutlines {
public:
    RegionOutlines(const VisibleMap& map, DrawnBorders borders);

    const VisibleMap& map() const { return map_; }

    /// Those that the borders' sides lie upon.
    const BorderCurves& curves() const { return borders_.curves; }

    std::size_t count() const { return starts_.size() - 1; }

    std::span<const VisibleMap::Ring> rings(std::size_t region) const {
        return std::span(map_.rings)
            .subspan(starts_[region], starts_[region + 1] - starts_[region]);
    }

    std::size_t corner_count(std::size_t region) const;

    /// As they are drawn: one for each of the region's rings.
    std::vector<BorderRing> borders(std::size_t region) const;

    /// A closed way along sides of rings, each given by the place of its first vertex in
    /// ring_vertices.
    BorderRing border(std::span<const std::uint32_t> sides) const;

private:
    const VisibleMap& map_;
    DrawnBorders borders_;
    std::vector<std::size_t> starts_; ///< of each region in the map's rings
};

} // namespace vera
