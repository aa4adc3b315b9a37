// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/image.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vera {

class OutputFile;

/// A part of a picture, in pixels from its upper left corner.
struct PixelRectangle {
    std::size_t x = 0;
    std::size_t y = 0;
    std::size_t width = 0;
    std::size_t height = 0;

    friend bool operator==(const PixelRectangle&, const PixelRectangle&) = default;
};

/// Pixels of one colour that follow each other in the order of reading: row after row, each from
/// the left.
struct ColorRun {
    std::size_t first = 0;
    std::size_t count = 0;
};

/// A picture of 8 or 16 bits in VERA's compressed raster (VERA 2.3, Displaying the Image;
/// docs/raster-format.md): runs of one colour, of the row above, and of interpolated colours, in
/// square tiles that are decoded each for itself. Decoded samples differ from those that were
/// written by at most largest_error().
class CompressedRaster {
public:
    /// Reads the header and the index, and checks that they are whole and that the tiles are where
    /// the index says; what the tiles hold is checked when they are decoded. The bytes must outlive
    /// the raster; the name is for messages. Throws InputError for what is damaged.
    CompressedRaster(std::span<const std::byte> bytes, std::string name);

    std::size_t width() const { return width_; }

    std::size_t height() const { return height_; }

    /// integer8 or integer16.
    SampleType type() const { return type_; }

    /// In samples of the type.
    unsigned largest_error() const { return largest_error_; }

    const PictureMetadata& metadata() const { return metadata_; }

    /// Width and height of a tile, but for those at the right and at the bottom.
    std::size_t tile_side() const { return tile_side_; }

    std::size_t tile_count() const { return tiles_.size(); }

    /// Where a tile lies; tiles are counted in rows from the upper left.
    PixelRectangle tile_place(std::size_t tile) const;

    /// The pixels of a rectangle that lies in the picture; only the tiles that it touches are
    /// decoded. Throws InputError where one is damaged, std::runtime_error when memory does not
    /// suffice.
    Image part(const PixelRectangle& rectangle) const;

    /// The same into a picture that keeps its memory, where that is enough.
    void read_part(const PixelRectangle& rectangle, Image& image) const;

    /// One tile as a picture of its own, written into `image`, which keeps its memory for the next;
    /// and those runs of it that its code calls constant, in their order.
    void decode(std::size_t tile, Image& image, std::vector<ColorRun>& runs) const;

private:
    struct Tile {
        std::size_t offset;
        std::size_t size;
        std::uint32_t checksum;
    };

    void read_header();
    void read_metadata(std::span<const std::byte> bytes);
    void read_index();
    void shape(Image& image, std::size_t width, std::size_t height) const;
    bool decode_samples(
        std::size_t tile,
        const PixelRectangle& part,
        Image& image,
        std::vector<ColorRun>* runs) const;
    [[noreturn]] void throw_damaged_tile(std::size_t tile) const;
    [[noreturn]] void damaged(const std::string& problem) const;

    std::span<const std::byte> bytes_;
    std::string name_;
    std::size_t width_ = 0;
    std::size_t height_ = 0;
    std::size_t channels_ = 3;
    SampleType type_ = SampleType::integer8;
    unsigned largest_error_ = 0;
    std::size_t tile_side_ = 0;
    std::size_t header_size_ = 0;
    PictureMetadata metadata_;
    std::vector<Tile> tiles_;
};

struct RasterWriteSettings {
    /// No sample differs by more from that of the image: 0 loses nothing. In samples of the image:
    /// at most 127 of 255, or 32639 of 65535.
    unsigned largest_error = 0;
    std::size_t tile_side = 256; ///< 1 to 512
};

/// Whether a picture has 1 sample a pixel in the file, since its red, green and blue are equal
/// everywhere, or 3, is found here. The image is not empty and has integer samples. Tiles are
/// written as they are ready, some at a time.
void write_compressed_raster(
    const Image& image,
    OutputFile& file,
    const PictureMetadata& metadata = {},
    const RasterWriteSettings& settings = {});

} // namespace vera
