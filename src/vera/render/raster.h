// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/render/sample_positions.h"
#include "vera/render/tiles.h"
#include "vera/scene/camera.h"

#include <algorithm>
#include <cstddef>

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

/// Visits the tile's pixels (x, y) square by square of 4 x 4: rays that follow one another then
/// stay close together, and an index that takes several at a time finds much in common in them.
template <typename Visitor>
void for_each_pixel(const Tile& tile, const Visitor& visit) {
    constexpr std::size_t side = 4;
    const std::size_t right = tile.x + tile.width;
    const std::size_t bottom = tile.y + tile.height;
    for (std::size_t first_y = tile.y; first_y < bottom; first_y += side)
        for (std::size_t first_x = tile.x; first_x < right; first_x += side)
            for (std::size_t y = first_y; y < std::min(first_y + side, bottom); ++y)
                for (std::size_t x = first_x; x < std::min(first_x + side, right); ++x)
                    visit(x, y);
}

} // namespace vera
