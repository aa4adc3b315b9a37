// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/compressed_raster.h"
#include "vera/image/image.h"

#include <span>
#include <vector>

namespace vera {

/// The picture in samples of another type, or of the same: integers are display-referred and floats
/// linear light, as docs/pictures.md tells, so that it looks the same. The light is multiplied by a
/// factor, which is finite and positive. From 8 bits to 16 or to floats and back nothing changes.
/// Throws std::runtime_error when memory does not suffice.
Image converted_image(const Image& image, SampleType type, double light_factor = 1);

/// The part of a picture that lies in a rectangle, which must lie in the picture.
Image part_of(const Image& image, const PixelRectangle& rectangle);

/// The rows of a picture from the top, in 8 bits (16 bits are rounded). Of a compressed raster no
/// more than one row of tiles is held at a time.
class PictureRows {
public:
    /// The picture must have integer samples, and outlive this.
    explicit PictureRows(const Image& image);
    explicit PictureRows(const CompressedRaster& raster);

    std::size_t width() const { return width_; }

    std::size_t height() const { return height_; }

    /// The next row's 3 * width() samples, until the next call. There must be one.
    std::span<const std::uint8_t> next();

private:
    const CompressedRaster* raster_ = nullptr;
    const Image* image_ = nullptr; ///< or, of the raster, band_
    Image band_;
    std::size_t width_;
    std::size_t height_;
    std::size_t y_ = 0;
    std::size_t band_start_ = 0;
    std::vector<std::uint8_t> rounded_;
};

} // namespace vera
