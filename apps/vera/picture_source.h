// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/compressed_raster.h"
#include "vera/image/converted_image.h"
#include "vera/image/palette.h"

#include <optional>
#include <string>
#include <vector>

namespace vera {

/// A picture that was read from a file, perhaps cut and brightened: a compressed raster stays
/// compressed for as long as it can.
class PictureSource {
public:
    /// The path may be "-"; crop as in "320x240+10+20", or empty; exposure in stops. Throws as
    /// read_image does, and CommandLineError where crop is not so or not within the picture.
    PictureSource(const std::string& path, const std::string& crop, double exposure);
    PictureSource(PictureSource&&) = default;
    PictureSource(const PictureSource&) = delete;
    PictureSource& operator=(const PictureSource&) = delete;
    PictureSource& operator=(PictureSource&&) = delete;
    ~PictureSource() = default;

    std::size_t width() const { return raster_ ? raster_->width() : image_.width; }

    std::size_t height() const { return raster_ ? raster_->height() : image_.height; }

    /// The whole picture.
    Image image(SampleType type);

    /// Makes floats bytes, which rows() and add_to() take.
    void display();

    /// This must outlive them.
    PictureRows rows() const { return raster_ ? PictureRows(*raster_) : PictureRows(image_); }

    void add_to(ColorHistogram& histogram) const;

private:
    void cut(const std::string& crop);
    void expand();

    std::vector<std::byte> bytes_; ///< of the file; raster_ looks into them
    std::optional<CompressedRaster> raster_;
    Image image_;
};

} // namespace vera
