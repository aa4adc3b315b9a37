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
    ViewRays rays;
    std::size_t width = 0;
    std::size_t height = 0;

    /// The ray that sees through that place of pixel (x, y), which may lie outside the picture.
    QueryRay ray(double x, double y, SamplePosition position = {}) const {
        QueryRay query;
        query.ray = rays.ray(across(x, position), down(y, position));
        return query;
    }

    /// As parts of the picture's width and height.
    double across(double x, SamplePosition position = {}) const {
        return (x + position.across) / static_cast<double>(width);
    }

    double down(double y, SamplePosition position = {}) const {
        return (y + position.down) / static_cast<double>(height);
    }
};

/// Visits the tile's pixels square by square of 4 x 4: rays that follow one another then stay close
/// together, and an index that takes several at a time finds much in common in them. Calls
/// visit(x, y, count) for the pixels (x, y) to (x + count - 1, y) of a square.
template <typename Visitor>
void for_each_run(const Tile& tile, const Visitor& visit) {
    constexpr std::size_t side = 4;
    const std::size_t right = tile.x + tile.width;
    const std::size_t bottom = tile.y + tile.height;
    for (std::size_t first_y = tile.y; first_y < bottom; first_y += side)
        for (std::size_t x = tile.x; x < right; x += side)
            for (std::size_t y = first_y; y < std::min(first_y + side, bottom); ++y)
                visit(x, y, std::min(side, right - x));
}

/// Calls visit(x, y) for each of these pixels, in the same order.
template <typename Visitor>
void for_each_pixel(const Tile& tile, const Visitor& visit) {
    for_each_run(tile, [&](std::size_t first_x, std::size_t y, std::size_t count) {
        for (std::size_t x = first_x; x < first_x + count; ++x)
            visit(x, y);
    });
}

} // namespace vera
