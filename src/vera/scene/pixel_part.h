// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace vera {

/// A part of a pixel in which one thing is seen, found by other means than rays.
struct PixelPart {
    /// Stands for no source: the background.
    static constexpr std::uint32_t background = ~std::uint32_t{0};

    std::uint32_t x = 0;
    std::uint32_t y = 0;
    std::uint32_t source = background; ///< what is seen
    double area = 1;                   ///< of the pixel's; those of its parts add up to 1
    double across = 0.5;               ///< the part's middle, from the pixel's left side, in pixels
    double down = 0.5;                 ///< and from its upper side
};

/// A picture whose parts are found band by band, of so many rows of pixels; the last may have less.
struct PixelBands {
    static constexpr std::size_t rows = 8;

    std::size_t width = 0;
    std::size_t height = 0;

    std::size_t count() const { return (height + rows - 1) / rows; }

    std::size_t first_row(std::size_t band) const { return band * rows; }

    std::size_t last_row(std::size_t band) const {
        return first_row(band + 1) < height ? first_row(band + 1) : height;
    }
};

} // namespace vera
