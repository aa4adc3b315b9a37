// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/image.h"

#include <cstddef>
#include <string>

namespace vera {

/// The picture smaller, by means of its light over the area of each new pixel, in 8 bits; never
/// larger than it was. Width and height must not be 0.
Image shrunk_image(const Image& image, std::size_t width, std::size_t height);

/// The width and height of the largest picture of the same shape that fits; each at least 1.
struct PictureSize {
    std::size_t width = 0;
    std::size_t height = 0;

    friend bool operator==(const PictureSize&, const PictureSize&) = default;
};

PictureSize fitted_size(const Image& image, std::size_t most_width, std::size_t most_height);

enum class TerminalColors { indexed256, rgb24 };

/// A picture of 8 bits as text: two pixels a character, one above the other, as upper half blocks
/// with a colour of their own and one behind them. Lines end in a reset of the colours.
std::string half_blocks(const Image& image, TerminalColors colors);

/// A picture of 8 bits for a terminal that knows kitty's graphics protocol: a PNG is not needed,
/// the samples are sent as they are, in base64 and in pieces of 4096 bytes.
std::string kitty_graphics(const Image& image);

} // namespace vera
