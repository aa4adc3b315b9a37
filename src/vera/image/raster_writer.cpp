// SPDX-License-Identifier: Apache-2.0
#include "vera/base/check.h"
#include "vera/base/output_file.h"
#include "vera/base/parallel.h"
#include "vera/image/codecs.h"
#include "vera/image/raster_layout.h"
#include "vera/image/raster_tile.h"

#include <stdexcept>

namespace vera {

namespace {

using namespace detail;

template <typename Sample>
bool is_grey(std::span<const Sample> samples) {
    for (std::size_t i = 0; i < samples.size(); i += 3)
        if (samples[i] != samples[i + 1] || samples[i] != samples[i + 2])
            return false;
    return true;
}

std::vector<std::byte> metadata_bytes(const PictureMetadata& metadata) {
    std::vector<std::byte> bytes;
    const auto append = [&bytes](const std::string& text) {
        append_number(bytes, text.size(), 4);
        const auto letters = std::as_bytes(std::span(text));
        bytes.insert(bytes.end(), letters.begin(), letters.end());
    };
    for (const auto& [name, value] : metadata) {
        append(name);
        append(value);
    }
    return bytes;
}

std::vector<std::byte> header(
    const Image& image,
    std::size_t channels,
    const PictureMetadata& metadata,
    const RasterWriteSettings& settings) {
    const std::vector<std::byte> texts = metadata_bytes(metadata);
    std::vector<std::byte> bytes;
    for (const char letter : raster_magic)
        bytes.push_back(static_cast<std::byte>(letter));
    append_number(bytes, raster_version, 2);
    append_number(bytes, 8 * size_of(sample_type(image)), 1);
    append_number(bytes, channels, 1);
    append_number(bytes, image.width, 4);
    append_number(bytes, image.height, 4);
    append_number(bytes, settings.tile_side, 2);
    append_number(bytes, settings.largest_error, 2);
    append_number(bytes, texts.size(), 4);
    bytes.insert(bytes.end(), texts.begin(), texts.end());
    append_number(bytes, checksum(bytes), checksum_size);
    return bytes;
}

/// The samples of a tile, of the first channel alone where there is one.
template <typename Sample>
std::vector<Sample>
tile_samples(const Image& image, const PixelRectangle& place, std::size_t channels) {
    const auto& samples = std::get<std::vector<Sample>>(image.samples);
    std::vector<Sample> tile;
    tile.reserve(channels * place.width * place.height);
    for (std::size_t y = 0; y < place.height; ++y) {
        const Sample* pixel = samples.data() + 3 * ((place.y + y) * image.width + place.x);
        for (std::size_t x = 0; x < place.width; ++x, pixel += 3)
            tile.insert(tile.end(), pixel, pixel + channels);
    }
    return tile;
}

template <typename Sample>
void write_samples(
    const Image& image,
    OutputFile& file,
    const PictureMetadata& metadata,
    const RasterWriteSettings& settings) {
    const std::size_t channels =
        is_grey(std::span<const Sample>(std::get<std::vector<Sample>>(image.samples))) ? 1 : 3;
    const std::vector<std::byte> head = header(image, channels, metadata, settings);
    file.write(head);

    const TileGrid grid = {image.width, image.height, settings.tile_side};
    // So many at a time: enough for all threads, and no picture's worth of memory.
    constexpr std::size_t most_tiles = 256;
    std::vector<std::byte> index;
    std::vector<std::vector<std::byte>> tiles;
    const std::size_t count = grid.columns() * grid.rows();
    for (std::size_t first = 0; first < count; first += most_tiles) {
        tiles.assign(std::min(most_tiles, count - first), {});
        parallel_ranges(tiles.size(), 1, [&](std::size_t from, std::size_t to) {
            for (std::size_t i = from; i < to; ++i) {
                const PixelRectangle place = grid.place(first + i);
                tiles[i] = encoded_tile<Sample>(
                    tile_samples<Sample>(image, place, channels),
                    {place.width, place.height},
                    channels,
                    settings.largest_error);
            }
        });
        for (const std::vector<std::byte>& tile : tiles) {
            file.write(tile);
            append_number(index, tile.size(), 4);
            append_number(index, checksum(tile), checksum_size);
        }
    }
    // Over the header as well, and by way of the index over every byte of the file.
    append_number(index, checksum(index, checksum(head)), checksum_size);
    file.write(index);
}

} // namespace

void write_compressed_raster(
    const Image& image,
    OutputFile& file,
    const PictureMetadata& metadata,
    const RasterWriteSettings& settings) {
    VERA_CHECK(sample_type(image) != SampleType::float32);
    VERA_CHECK(settings.tile_side >= 1 && settings.tile_side <= largest_tile_side);
    VERA_CHECK(settings.largest_error <= largest_raster_error(sample_type(image)));
    if (image.width > largest_raster_side || image.height > largest_raster_side)
        throw std::runtime_error(
            "cannot write " + file.name()
            + ": a compressed raster has at most 2147483647 pixels a side");
    if (sample_type(image) == SampleType::integer8)
        write_samples<std::uint8_t>(image, file, metadata, settings);
    else
        write_samples<std::uint16_t>(image, file, metadata, settings);
}

namespace detail {

void write_vra(
    const Image& image,
    OutputFile& file,
    const PictureMetadata& metadata,
    const ImageWriteSettings& settings) {
    write_compressed_raster(image, file, metadata, {.largest_error = settings.raster_error});
}

} // namespace detail

} // namespace vera
