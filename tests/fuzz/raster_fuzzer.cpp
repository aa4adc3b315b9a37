// SPDX-License-Identifier: Apache-2.0
// The code of a tile, behind the checksums that keep a fuzzer of whole files out. The first four
// bytes choose the tile's shape and kind.
#include "vera/image/raster_tile.h"

#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 4)
        return 0;
    const vera::detail::TileShape shape = {1 + data[0] % 40U, 1 + data[1] % 40U};
    const std::size_t channels = data[2] % 2 == 0 ? 1 : 3;
    const auto bytes = std::as_bytes(std::span(data, size).subspan(4));
    if (data[2] % 4 < 2) {
        std::vector<std::uint8_t> samples;
        vera::detail::decode_tile(bytes, shape, channels, data[3] % 128U, samples);
    } else {
        std::vector<std::uint16_t> samples;
        vera::detail::decode_tile(bytes, shape, channels, 257 * (data[3] % 128U), samples);
    }
    return 0;
}
