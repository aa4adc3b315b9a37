// SPDX-License-Identifier: Apache-2.0
#include "vera/image/converted_image.h"

#include "vera/base/check.h"
#include "vera/base/parallel.h"
#include "vera/image/develop.h"
#include "vera/math/elementary.h"

#include <algorithm>
#include <limits>
#include <type_traits>

namespace vera {

namespace {

/// The display-referred value of a sample, of which a factor was put on the light.
template <typename Sample>
double displayed(Sample sample, double light_factor) {
    if constexpr (std::is_same_v<Sample, float>)
        return srgb_encoded(light_factor * static_cast<double>(sample));
    else {
        const double value = static_cast<double>(sample) / std::numeric_limits<Sample>::max();
        return light_factor == 1 ? value : srgb_encoded(light_factor * srgb_decoded(value));
    }
}

} // namespace

Image converted_image(const Image& image, SampleType type, double light_factor) {
    if (type == sample_type(image) && light_factor == 1)
        return image;
    Image result = blank_image(image.width, image.height, type);
    constexpr std::size_t grain = 16;
    std::visit(
        [&](const auto& samples) {
            parallel_ranges(image.height, grain, [&](std::size_t first, std::size_t last) {
                std::vector<Color> colors(image.width);
                for (std::size_t y = first; y < last; ++y) {
                    const auto* sample = samples.data() + 3 * image.width * y;
                    for (Color& color : colors) {
                        color.r = displayed(*sample++, light_factor);
                        color.g = displayed(*sample++, light_factor);
                        color.b = displayed(*sample++, light_factor);
                    }
                    develop(colors, result, 0, y);
                }
            });
        },
        image.samples);
    return result;
}

Image part_of(const Image& image, const PixelRectangle& rectangle) {
    VERA_CHECK(rectangle.x <= image.width && rectangle.width <= image.width - rectangle.x);
    VERA_CHECK(rectangle.y <= image.height && rectangle.height <= image.height - rectangle.y);
    Image part = blank_image(rectangle.width, rectangle.height, sample_type(image));
    std::visit(
        [&](auto& to) {
            const auto& from = std::get<std::decay_t<decltype(to)>>(image.samples);
            for (std::size_t y = 0; y < rectangle.height; ++y)
                std::copy_n(
                    from.data() + 3 * ((rectangle.y + y) * image.width + rectangle.x),
                    3 * rectangle.width,
                    to.data() + 3 * y * rectangle.width);
        },
        part.samples);
    return part;
}

PictureRows::PictureRows(const Image& image)
    : image_(&image)
    , width_(image.width)
    , height_(image.height) {
    VERA_CHECK(sample_type(image) != SampleType::float32);
}

PictureRows::PictureRows(const CompressedRaster& raster)
    : raster_(&raster)
    , width_(raster.width())
    , height_(raster.height()) {}

std::span<const std::uint8_t> PictureRows::next() {
    VERA_CHECK(y_ < height_);
    if (raster_ != nullptr && y_ == band_start_ + band_.height) {
        band_start_ = y_;
        raster_->read_part({0, y_, width_, std::min(raster_->tile_side(), height_ - y_)}, band_);
    }
    const std::size_t first = 3 * width_ * (y_ - band_start_);
    ++y_;
    const auto& samples = (raster_ != nullptr ? band_ : *image_).samples;
    if (const auto* bytes = std::get_if<std::vector<std::uint8_t>>(&samples))
        return std::span(*bytes).subspan(first, 3 * width_);
    const auto wide = std::span(std::get<std::vector<std::uint16_t>>(samples));
    rounded_.clear();
    for (const unsigned sample : wide.subspan(first, 3 * width_))
        rounded_.push_back(static_cast<std::uint8_t>((sample + 128) / 257));
    return rounded_;
}

} // namespace vera
