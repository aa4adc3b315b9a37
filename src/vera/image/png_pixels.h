// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <zlib.h>

namespace vera::detail {

/// How a PNG picture holds its pixels.
struct PngLayout {
    std::size_t width = 0;
    std::size_t pixel_bytes = 3;
    bool swapped = false; ///< samples are given with their two bytes in the other order
    int compression = 1;  ///< of zlib, 0 to 9
};

/// Makes the content of a PNG picture's IDAT chunks, row by row: filters each row by the pixels to
/// the left or by those above, whichever leaves less (libpng's rule, at a third of its time), and
/// compresses what is left. Holds memory for some rows, and takes none while it works.
class PngPixels {
public:
    explicit PngPixels(const PngLayout& layout);
    ~PngPixels();
    PngPixels(const PngPixels&) = delete;
    PngPixels& operator=(const PngPixels&) = delete;

    /// Filters the next row, which compress() then takes up.
    void add_row(const unsigned char* row);

    enum class Rest : std::uint8_t { more_rows, none };

    /// Goes on compressing. False when the content made so far, one chunk, has to be fetched first.
    bool compress(Rest rest);

    /// What was made since the last call, valid until compress() is called again.
    std::span<const unsigned char> fetch();

private:
    PngLayout layout_;
    std::vector<unsigned char> above_;
    std::vector<unsigned char> row_;
    std::vector<unsigned char> by_left_; ///< both with the number of their filter in front
    std::vector<unsigned char> by_above_;
    std::vector<unsigned char> chunk_;
    std::size_t waiting_ = 0; ///< of the filtered row
    z_stream stream_ = {};
};

} // namespace vera::detail
