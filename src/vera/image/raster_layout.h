// SPDX-License-Identifier: Apache-2.0
// How the parts of a compressed raster follow each other; docs/raster-format.md tells it in words.
#pragma once

#include "vera/image/compressed_raster.h"

#include <algorithm>
#include <string_view>

#include <zlib.h>

namespace vera::detail {

/// The first bytes of every file. What text conversions do to files damages them.
constexpr std::string_view raster_magic = "\x89VRA\r\n\x1a\n";

constexpr std::size_t raster_version = 1;

/// Magic, version, bits, channels, width, height, tile side, error, size of the metadata.
constexpr std::size_t fixed_header_size = 8 + 2 + 1 + 1 + 4 + 4 + 2 + 2 + 4;
constexpr std::size_t checksum_size = 4;
constexpr std::size_t index_entry_size = 8; ///< size and checksum
constexpr std::size_t largest_raster_side = (std::size_t{1} << 31) - 1;

constexpr unsigned largest_raster_error(SampleType type) {
    return type == SampleType::integer16 ? 127 * 257 : 127;
}

inline std::uint32_t checksum(std::span<const std::byte> bytes, std::uint32_t before = 0) {
    return static_cast<std::uint32_t>(
        crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

/// Unsigned numbers, the lowest byte first.
inline void append_number(std::vector<std::byte>& bytes, std::size_t number, std::size_t size) {
    for (; size > 0; --size, number >>= 8)
        bytes.push_back(static_cast<std::byte>(number & 255));
}

inline std::size_t number_at(std::span<const std::byte> bytes, std::size_t at, std::size_t size) {
    std::size_t number = 0;
    for (std::size_t i = size; i-- > 0;)
        number = number << 8 | std::to_integer<std::size_t>(bytes[at + i]);
    return number;
}

/// How the tiles of a picture lie.
struct TileGrid {
    std::size_t width;
    std::size_t height;
    std::size_t side;

    std::size_t columns() const { return (width + side - 1) / side; }

    std::size_t rows() const { return (height + side - 1) / side; }

    PixelRectangle place(std::size_t tile) const {
        const std::size_t x = tile % columns() * side;
        const std::size_t y = tile / columns() * side;
        return {x, y, std::min(side, width - x), std::min(side, height - y)};
    }
};

} // namespace vera::detail
