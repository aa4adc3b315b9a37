// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/render/sample_positions.h"
#include "vera/render/tiles.h"
#include "vera/scene/camera.h"

#include <cstddef>
#include <vector>

namespace vera {

/// The raster that a camera's picture is divided into.
struct Raster {
    const Camera& camera;
    std::size_t width = 0;
    std::size_t height = 0;

    /// The ray that sees through that place of pixel (x, y), which may lie outside the picture.
    QueryRay ray(double x, double y, SamplePosition position = {}) const {
        QueryRay query;
        query.ray = view_ray(
            camera,
            (x + position.across) / static_cast<double>(width),
            (y + position.down) / static_cast<double>(height));
        return query;
    }
};

/// One ray through the middle of each of the tile's pixels, row by row.
inline void view_rays(const Raster& raster, const Tile& tile, std::vector<QueryRay>& rays) {
    rays.clear();
    for (std::size_t y = tile.y; y < tile.y + tile.height; ++y)
        for (std::size_t x = tile.x; x < tile.x + tile.width; ++x)
            rays.push_back(raster.ray(static_cast<double>(x), static_cast<double>(y)));
}

} // namespace vera
