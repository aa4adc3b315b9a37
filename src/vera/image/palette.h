// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/image.h"
#include "vera/image/oklab.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vera {

class CompressedRaster;

/// A table of 1 to 256 colours. Pixels of a picture in these are numbers of colours.
using Palette = std::vector<Rgb8>;

/// A palette that has a name: bw (black and white), rgb8 and ega16 (of old displays), web216 (six
/// steps a channel), terminal256 (of a terminal, as xterm defines them).
std::optional<Palette> named_palette(std::string_view name);

/// "bw, rgb8, ..."
std::string palette_names();

/// The colours of a text: one of "#rrggbb" a line, empty lines and what follows ";" left out. The
/// name is for messages. Throws InputError with every wrong line.
Palette palette_from_text(std::string_view text, const std::string& name);

/// How often colours occur, in 32 x 64 x 32 cells of red, green and blue: sums of what fell in
/// each. Whole numbers, so that it does not matter in what order pixels are added.
class ColorHistogram {
public:
    ColorHistogram();

    void add(Rgb8 color, std::uint64_t count = 1);

    /// The pixels of a picture of 8 bits.
    void add(const Image& image);

    /// The pixels of a compressed raster, tile by tile; runs of one colour are added at once. Never
    /// holds more than a tile. 16 bits are rounded to 8.
    void add(const CompressedRaster& raster);

    /// A cell that something fell in.
    struct Entry {
        Oklab mean;
        double weight = 0;
    };

    std::vector<Entry> entries() const;

    bool empty() const;

private:
    struct Cell {
        std::array<std::uint64_t, 3> sums = {};
        std::uint64_t count = 0;
    };

    std::vector<Cell> cells_;
};

/// At most so many colours for what the histogram holds, which must not be empty: by cutting boxes
/// in Oklab where the variance falls most (after X. Wu, "Color quantization by dynamic programming
/// and principal analysis", 1992), then by k-means. Fewer where the picture has fewer. Sorted from
/// dark to light.
Palette optimal_palette(const ColorHistogram& histogram, std::size_t most_colors);

/// The number of the colour that is nearest in Oklab, and the first of several.
std::size_t nearest_color(std::span<const Oklab> colors, const Oklab& color);

} // namespace vera
