// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/cell_raster.h"
#include "vera/visible/screen_scene.h"
#include "vera/visible/visible_map.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

constexpr std::uint32_t no_way = ~std::uint32_t{0};

/// The two ways along a piece: 2 i with, 2 i + 1 against its edge.
class Ways {
public:
    Ways(const ScreenScene& scene, const std::vector<VisiblePiece>& pieces)
        : region(2 * pieces.size(), no_region)
        , scene_(scene)
        , pieces_(pieces) {}

    std::size_t count() const { return region.size(); }

    /// Where the way begins.
    std::uint32_t from(std::uint32_t way) const {
        const VisiblePiece& piece = pieces_[way / 2];
        return way % 2 == 0 ? piece.from : piece.to;
    }

    std::uint32_t to(std::uint32_t way) const { return from(way ^ 1U); }

    /// Along the whole edge.
    ScreenStep direction(std::uint32_t way) const {
        const ScreenEdges::Edge& edge = pieces_[way / 2].edge;
        const ScreenPoint begin = scene_.vertices[edge.begin].point;
        const ScreenPoint end = scene_.vertices[edge.end].point;
        return way % 2 == 0 ? step(begin, end) : step(end, begin);
    }

    std::vector<std::uint32_t> region; ///< seen on the left

private:
    const ScreenScene& scene_;
    const std::vector<VisiblePiece>& pieces_;
};

} // namespace vera
