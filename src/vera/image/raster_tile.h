// SPDX-License-Identifier: Apache-2.0
// The code of one tile of a compressed raster: what its bytes mean, as docs/raster-format.md tells.
#pragma once

#include "vera/image/compressed_raster.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera::detail {

struct TileShape {
    std::size_t width = 0;
    std::size_t height = 0;

    std::size_t pixels() const { return width * height; }
};

/// The tile's bytes. Pixels have 1 or 3 samples side by side; no decoded sample differs from the
/// one given by more than largest_error, and never are there more bytes than without an error.
template <typename Sample>
std::vector<std::byte> encoded_tile(
    std::span<const Sample> samples, TileShape shape, std::size_t channels, unsigned largest_error);

/// Makes `samples` the tile's, shape.pixels() * channels of them and some more that mean nothing;
/// false when the bytes are damaged, or may be off by more than largest_error. What is known to be
/// constant from the code alone is appended to runs, if these are asked for.
template <typename Sample>
bool decode_tile(
    std::span<const std::byte> bytes,
    TileShape shape,
    std::size_t channels,
    unsigned largest_error,
    std::vector<Sample>& samples,
    std::vector<ColorRun>* runs = nullptr);

/// The most pixels that a tile has.
constexpr std::size_t largest_tile_side = 512;

// A command is one byte. Below small_end it is a pixel whose differences from its prediction are
// small, then come pixels with larger ones, and four kinds of runs, each with its length.
enum class RunKind : std::uint8_t { constant, above, across, along };

constexpr int run_kinds = 4;
constexpr int small_green = 3; ///< a small difference of the first sample is from -3 to 3
constexpr int small_other = 2; ///< and those of others differ from it by -2 to 2
constexpr int small_end = (2 * small_green + 1) * (2 * small_other + 1) * (2 * small_other + 1);
constexpr int difference_command = small_end;            ///< a byte a channel
constexpr int plain_command = small_end + 1;             ///< the samples themselves
constexpr int first_run_command = small_end + 2;         ///< 18 commands a kind of run
constexpr int short_lengths = 16;                        ///< 1 to 16 are in the command
constexpr int run_commands = short_lengths + 2;          ///< one or two bytes of the length follow
constexpr std::size_t medium_length = 17;                ///< the least with one byte
constexpr std::size_t long_length = medium_length + 256; ///< the least with two bytes
constexpr std::size_t longest_run = long_length + 65535;
static_assert(first_run_command + run_kinds * run_commands <= 256);

/// The bytes of a tile, by what they mean: each is compressed for itself.
struct TileStreams {
    unsigned error = 0; ///< no sample is off by more
    std::vector<std::uint8_t> commands;
    std::vector<std::uint8_t> lengths;
    std::array<std::vector<std::uint8_t>, 3> values; ///< by channel

    static constexpr std::size_t count = 5;
};

std::vector<std::byte> packed(const TileStreams& streams);

/// False when the bytes are damaged, or when a stream would be longer than `longest`.
bool unpack(std::span<const std::byte> bytes, std::size_t longest, TileStreams& streams);

/// The median of left, above, and left + above - above_left: the plane through the three where that
/// lies between left and above, and on an edge the neighbour on this side of it.
constexpr int predicted(int left, int above, int above_left) {
    const int least = left < above ? left : above;
    const int most = left < above ? above : left;
    const int plane = left + above - above_left;
    return plane < least ? least : (plane > most ? most : plane);
}

template <typename Sample>
constexpr int clamped_sample(int value) {
    constexpr int largest = Sample(-1);
    return value < 0 ? 0 : (value > largest ? largest : value);
}

/// A straight line from one value by `difference` within `count` steps, in fixed point: step k
/// lies at from + rise(slope, k). Its last step is exact, since count * 1 / 65536 is below 1 / 2.
constexpr std::int32_t line_slope(int difference, std::size_t count) {
    const std::int64_t scaled = std::int64_t{difference} * 65536;
    const auto steps = static_cast<std::int64_t>(count);
    return static_cast<std::int32_t>(
        scaled >= 0 ? scaled / steps : -((-scaled + steps - 1) / steps));
}

constexpr int line_rise(std::int32_t slope, std::size_t k) {
    return static_cast<int>((std::int64_t{slope} * static_cast<std::int64_t>(k) + 32768) >> 16);
}

} // namespace vera::detail
