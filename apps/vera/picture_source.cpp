// SPDX-License-Identifier: Apache-2.0
#include "picture_source.h"

#include "vera/image/image_file.h"
#include "vera/math/elementary.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "command.h"
#include <fmt/format.h>

namespace vera {

namespace {

/// "320x240+10+20"; nothing where it is not so. Numbers larger than any picture's become less.
std::optional<PixelRectangle> rectangle_from(std::string_view text) {
    constexpr std::string_view separators = "x++";
    constexpr std::size_t most = (std::size_t{1} << 31) - 1;
    std::array<std::size_t, 4> numbers = {};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (i > 0 && (text.empty() || text.front() != separators[i - 1]))
            return std::nullopt;
        text.remove_prefix(i > 0 ? 1 : 0);
        const auto [end, error] =
            std::from_chars(text.data(), text.data() + text.size(), numbers[i]);
        if (error == std::errc::invalid_argument)
            return std::nullopt;
        numbers[i] = error == std::errc() ? std::min(numbers[i], most) : most;
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    }
    if (!text.empty() || numbers[0] == 0 || numbers[1] == 0)
        return std::nullopt;
    return PixelRectangle{numbers[2], numbers[3], numbers[0], numbers[1]};
}

PixelRectangle crop_rectangle(const std::string& text, std::size_t width, std::size_t height) {
    const auto place = rectangle_from(text);
    if (!place)
        throw CommandLineError(fmt::format(
            "--crop takes WIDTHxHEIGHT+X+Y in pixels, as in 320x240+10+20; found '{}'", text));
    if (place->x + place->width > width || place->y + place->height > height)
        throw CommandLineError(fmt::format(
            "--crop {} is not within the picture, which has {} x {} pixels; take less, or from "
            "further left and up",
            text,
            width,
            height));
    return *place;
}

} // namespace

PictureSource::PictureSource(const std::string& path, const std::string& crop, double exposure)
    : bytes_(file_bytes(path)) {
    const std::string name = path == "-" ? "standard input" : path;
    const std::string_view text(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
    if (text.starts_with("\x89VRA"))
        raster_.emplace(bytes_, name);
    else
        image_ = decoded_image(bytes_, name);
    if (!crop.empty())
        cut(crop);
    if (exposure != 0) {
        expand();
        image_ = converted_image(image_, sample_type(image_), exp2_of(exposure));
    }
}

Image PictureSource::image(SampleType type) {
    expand();
    return converted_image(image_, type);
}

void PictureSource::display() {
    if (!raster_ && sample_type(image_) == SampleType::float32)
        image_ = converted_image(image_, SampleType::integer8);
}

void PictureSource::add_to(ColorHistogram& histogram) const {
    if (raster_) {
        histogram.add(*raster_);
        return;
    }
    PictureRows all = rows();
    for (std::size_t y = 0; y < image_.height; ++y) {
        const auto row = all.next();
        for (std::size_t i = 0; i < row.size(); i += 3)
            histogram.add({row[i], row[i + 1], row[i + 2]});
    }
}

void PictureSource::cut(const std::string& crop) {
    const PixelRectangle place = crop_rectangle(crop, width(), height());
    image_ = raster_ ? raster_->part(place) : part_of(image_, place);
    raster_.reset();
}

void PictureSource::expand() {
    if (raster_)
        image_ = raster_->part({0, 0, raster_->width(), raster_->height()});
    raster_.reset();
}

} // namespace vera
