// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/render/generation_size.h"

#include <algorithm>
#include <cstddef>

namespace vera {

/// Pixels [x, x + width) x [y, y + height) of a picture.
struct Tile {
    std::size_t x = 0;
    std::size_t y = 0;
    std::size_t width = 0;
    std::size_t height = 0;
};

/// The side of tiles that is usual, or of one of the whole picture, so that generations are whole.
constexpr std::size_t
tile_side(std::size_t usual, std::size_t generation_size, std::size_t width, std::size_t height) {
    return generation_size == whole_generations ? std::max({width, height, std::size_t{1}}) : usual;
}

/// A picture cut into squares, those at the right and lower edges smaller, numbered row by row.
struct Tiling {
    std::size_t width = 0;
    std::size_t height = 0;
    std::size_t side = 1;

    std::size_t columns() const { return (width + side - 1) / side; }

    std::size_t rows() const { return (height + side - 1) / side; }

    std::size_t count() const { return columns() * rows(); }

    Tile tile(std::size_t number) const {
        const std::size_t x = number % columns() * side;
        const std::size_t y = number / columns() * side;
        return {x, y, std::min(side, width - x), std::min(side, height - y)};
    }

    std::size_t tile_of(std::size_t x, std::size_t y) const {
        return y / side * columns() + x / side;
    }
};

} // namespace vera
