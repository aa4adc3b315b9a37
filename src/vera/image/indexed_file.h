// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/image.h"
#include "vera/image/palette.h"

#include <functional>
#include <span>

namespace vera {

class OutputFile;

/// A picture whose pixels are numbers of a palette's colours, made row by row while it is written.
struct IndexedPicture {
    std::size_t width = 0;
    std::size_t height = 0;
    Palette palette = {};
    /// Fills the next row's width numbers; called height times.
    std::function<void(std::span<std::uint8_t> numbers)> next_row = {};
};

/// With a palette, in 1, 2, 4 or 8 bits a pixel, whichever are enough. The caller commits.
void write_indexed_png(
    const IndexedPicture& picture, OutputFile& file, const PictureMetadata& metadata = {});

/// GIF, version 89a. Several pictures, of one size, are shown in turn, each for so many hundredths
/// of a second, without end. At most 65535 pixels a side.
void write_gif(
    std::span<const IndexedPicture> pictures, OutputFile& file, unsigned delay_hundredths = 0);

} // namespace vera
