// SPDX-License-Identifier: Apache-2.0
#include "vera/image/compressed_raster.h"

#include "vera/base/check.h"
#include "vera/base/parallel.h"
#include "vera/image/codecs.h"
#include "vera/image/raster_layout.h"
#include "vera/image/raster_tile.h"

#include <fmt/format.h>

namespace vera {

namespace {

using namespace detail;

constexpr std::size_t bits_at = 10;
constexpr std::size_t channels_at = 11;
constexpr std::size_t width_at = 12;
constexpr std::size_t height_at = 16;
constexpr std::size_t side_at = 20;
constexpr std::size_t error_at = 22;
constexpr std::size_t metadata_size_at = 24;

/// What two rectangles have in common; no pixels when they do not meet.
PixelRectangle common(const PixelRectangle& a, const PixelRectangle& b) {
    const std::size_t x = std::max(a.x, b.x);
    const std::size_t y = std::max(a.y, b.y);
    const std::size_t right = std::min(a.x + a.width, b.x + b.width);
    const std::size_t below = std::min(a.y + a.height, b.y + b.height);
    return {x, y, right > x ? right - x : 0, below > y ? below - y : 0};
}

/// Copies what a tile, of 1 or 3 samples a pixel, and a part of the picture have in common.
template <typename Sample>
void copy_common(
    const Sample* tile,
    const PixelRectangle& tile_place,
    std::size_t channels,
    Sample* part,
    const PixelRectangle& part_place) {
    const PixelRectangle both = common(tile_place, part_place);
    for (std::size_t y = both.y; y < both.y + both.height; ++y) {
        const Sample* from =
            tile + channels * ((y - tile_place.y) * tile_place.width + both.x - tile_place.x);
        Sample* to = part + 3 * ((y - part_place.y) * part_place.width + both.x - part_place.x);
        if (channels == 3) {
            std::copy_n(from, 3 * both.width, to);
            continue;
        }
        for (std::size_t x = 0; x < both.width; ++x, to += 3)
            std::fill_n(to, 3, from[x]);
    }
}

} // namespace

CompressedRaster::CompressedRaster(std::span<const std::byte> bytes, std::string name)
    : bytes_(bytes)
    , name_(std::move(name)) {
    read_header();
    read_index();
}

void CompressedRaster::damaged(const std::string& problem) const {
    throw_damaged(name_, problem);
}

void CompressedRaster::read_header() {
    if (bytes_.size() < fixed_header_size + 2 * checksum_size)
        damaged("it ends early, in its header");
    const std::size_t version = number_at(bytes_, raster_magic.size(), 2);
    if (version != raster_version)
        damaged(fmt::format(
            "it is a compressed raster of version {}, and version {} is known here",
            version,
            raster_version));
    const std::size_t metadata_size = number_at(bytes_, metadata_size_at, 4);
    if (metadata_size > bytes_.size() - fixed_header_size - 2 * checksum_size)
        damaged("it ends early, in its metadata");
    const std::size_t checked = fixed_header_size + metadata_size;
    header_size_ = checked + checksum_size;
    if (number_at(bytes_, checked, checksum_size) != checksum(bytes_.first(checked)))
        damaged("its header is not what was written: the checksum differs");

    const std::size_t bits = number_at(bytes_, bits_at, 1);
    type_ = bits == 16 ? SampleType::integer16 : SampleType::integer8;
    channels_ = number_at(bytes_, channels_at, 1);
    width_ = number_at(bytes_, width_at, 4);
    height_ = number_at(bytes_, height_at, 4);
    tile_side_ = number_at(bytes_, side_at, 2);
    largest_error_ = static_cast<unsigned>(number_at(bytes_, error_at, 2));
    if ((bits != 8 && bits != 16) || (channels_ != 1 && channels_ != 3))
        damaged(fmt::format("it has {} samples of {} bits a pixel", channels_, bits));
    if (width_ == 0 || height_ == 0 || width_ > largest_raster_side
        || height_ > largest_raster_side)
        damaged(fmt::format("it has {} x {} pixels", width_, height_));
    if (tile_side_ == 0 || tile_side_ > largest_tile_side)
        damaged(fmt::format(
            "its tiles have {} pixels a side, and may have 1 to {}",
            tile_side_,
            largest_tile_side));
    if (largest_error_ > largest_raster_error(type_))
        damaged(fmt::format(
            "it allows an error of {}, and at most {} can be",
            largest_error_,
            largest_raster_error(type_)));
    read_metadata(bytes_.subspan(fixed_header_size, metadata_size));
}

void CompressedRaster::read_metadata(std::span<const std::byte> bytes) {
    const auto take_text = [this, &bytes] {
        if (bytes.size() < 4 || number_at(bytes, 0, 4) > bytes.size() - 4)
            damaged("a text of its metadata is longer than all of them");
        const std::size_t size = number_at(bytes, 0, 4);
        std::string text(reinterpret_cast<const char*>(bytes.data()) + 4, size);
        bytes = bytes.subspan(4 + size);
        return text;
    };
    while (!bytes.empty()) {
        const std::string name = take_text();
        metadata_.emplace_back(name, take_text());
    }
}

void CompressedRaster::read_index() {
    const TileGrid grid = {width_, height_, tile_side_};
    const std::size_t rest = bytes_.size() - header_size_ - checksum_size;
    // Divided, since a product may not fit; then nothing is taken for tiles that are not there.
    if (grid.rows() > rest / index_entry_size / grid.columns())
        damaged(fmt::format(
            "{} bytes cannot hold the {} x {} pixels that its header promises",
            bytes_.size(),
            width_,
            height_));
    const std::size_t count = grid.columns() * grid.rows();
    const std::size_t index_size = count * index_entry_size;
    const auto index = bytes_.subspan(bytes_.size() - checksum_size - index_size, index_size);
    if (number_at(bytes_, bytes_.size() - checksum_size, checksum_size)
        != checksum(index, checksum(bytes_.first(header_size_))))
        damaged("it ends early, or its index is not what was written: the checksum differs");

    std::size_t offset = header_size_;
    std::size_t left = rest - index_size;
    tiles_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t size = number_at(index, i * index_entry_size, 4);
        if (size > left)
            damaged("its tiles are longer than the file");
        tiles_.push_back(
            {offset,
             size,
             static_cast<std::uint32_t>(number_at(index, i * index_entry_size + 4, 4))});
        offset += size;
        left -= size;
    }
    if (left != 0)
        damaged("there is something between its tiles and its index");
}

PixelRectangle CompressedRaster::tile_place(std::size_t tile) const {
    return TileGrid{width_, height_, tile_side_}.place(tile);
}

bool CompressedRaster::decode_samples(
    std::size_t tile, const PixelRectangle& part, Image& image, std::vector<ColorRun>* runs) const {
    const PixelRectangle place = tile_place(tile);
    const auto bytes = bytes_.subspan(tiles_[tile].offset, tiles_[tile].size);
    return std::visit(
        [&](auto& samples) {
            using Sample = typename std::decay_t<decltype(samples)>::value_type;
            if constexpr (std::is_same_v<Sample, float>) {
                return false; // never: type_ is of integers
            } else {
                thread_local std::vector<Sample> decoded;
                if (checksum(bytes) != tiles_[tile].checksum
                    || !decode_tile<Sample>(
                        bytes,
                        {place.width, place.height},
                        channels_,
                        largest_error_,
                        decoded,
                        runs))
                    return false;
                copy_common(decoded.data(), place, channels_, samples.data(), part);
                return true;
            }
        },
        image.samples);
}

void CompressedRaster::throw_damaged_tile(std::size_t tile) const {
    const PixelRectangle place = tile_place(tile);
    damaged(fmt::format("its tile at pixel {}, {} is not what was written", place.x, place.y));
}

Image CompressedRaster::part(const PixelRectangle& rectangle) const {
    Image image = blank_image(rectangle.width, rectangle.height, type_);
    read_part(rectangle, image);
    return image;
}

void CompressedRaster::shape(Image& image, std::size_t width, std::size_t height) const {
    const std::size_t count = 3 * width * height;
    const bool enough = sample_type(image) == type_
        && std::visit([count](const auto& samples) { return samples.capacity() >= count; },
                      image.samples);
    if (!enough)
        image = blank_image(width, height, type_);
    image.width = width;
    image.height = height;
    std::visit([count](auto& samples) { samples.resize(count); }, image.samples);
}

void CompressedRaster::read_part(const PixelRectangle& rectangle, Image& image) const {
    VERA_CHECK(rectangle.x <= width_ && rectangle.width <= width_ - rectangle.x);
    VERA_CHECK(rectangle.y <= height_ && rectangle.height <= height_ - rectangle.y);
    shape(image, rectangle.width, rectangle.height);
    if (rectangle.width == 0 || rectangle.height == 0)
        return;

    const std::size_t columns = (width_ + tile_side_ - 1) / tile_side_;
    const std::size_t first_column = rectangle.x / tile_side_;
    const std::size_t first_row = rectangle.y / tile_side_;
    const std::size_t across = (rectangle.x + rectangle.width - 1) / tile_side_ - first_column + 1;
    const std::size_t down = (rectangle.y + rectangle.height - 1) / tile_side_ - first_row + 1;
    const auto tile_at = [&](std::size_t i) {
        return (first_row + i / across) * columns + first_column + i % across;
    };
    std::vector<std::uint8_t> is_good(across * down);
    parallel_ranges(is_good.size(), 1, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i)
            is_good[i] = decode_samples(tile_at(i), rectangle, image, nullptr) ? 1 : 0;
    });
    for (std::size_t i = 0; i < is_good.size(); ++i)
        if (is_good[i] == 0)
            throw_damaged_tile(tile_at(i));
}

void CompressedRaster::decode(std::size_t tile, Image& image, std::vector<ColorRun>& runs) const {
    const PixelRectangle place = tile_place(tile);
    shape(image, place.width, place.height);
    runs.clear();
    if (!decode_samples(tile, place, image, &runs))
        throw_damaged_tile(tile);
}

namespace detail {

Image read_vra(std::span<const std::byte> bytes, const std::string& name) {
    const CompressedRaster raster(bytes, name);
    return raster.part({0, 0, raster.width(), raster.height()});
}

} // namespace detail

} // namespace vera
