// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/scene/picture_settings.h"
#include "vera/visible/visible_map.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// The regions of a map, by their numbers, as outlines in pixels. The map must outlive it.
class RegionOutlines {
public:
    RegionOutlines(const VisibleMap& map, const PictureSettings& picture);

    const VisibleMap& map() const { return map_; }

    std::size_t count() const { return starts_.size() - 1; }

    std::span<const VisibleMap::Ring> rings(std::size_t region) const {
        return std::span(map_.rings)
            .subspan(starts_[region], starts_[region + 1] - starts_[region]);
    }

    std::size_t corner_count(std::size_t region) const;

    /// Adds a ring through vertices of the map.
    void add_ring(std::span<const std::uint32_t> vertices, FilledOutline& outline) const;

    /// Adds those of the region.
    void add_rings(std::size_t region, FilledOutline& outline) const;

private:
    const VisibleMap& map_;
    double width_; ///< of the picture, in pixels
    double height_;
    std::vector<std::size_t> starts_; ///< of each region in the map's rings
};

} // namespace vera
