// SPDX-License-Identifier: Apache-2.0
#include "vera/image/raster_tile.h"

#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>

#include <zstd.h>

namespace vera::detail {

namespace {

void append_number(std::vector<std::byte>& bytes, std::size_t number) {
    for (; number >= 128; number >>= 7)
        bytes.push_back(static_cast<std::byte>((number & 127) | 128));
    bytes.push_back(static_cast<std::byte>(number));
}

/// Takes a number of seven bits a byte from the front; false where there is none.
bool take_number(std::span<const std::byte>& bytes, std::size_t& number) {
    number = 0;
    for (int shift = 0; shift < 28; shift += 7) {
        if (bytes.empty())
            return false;
        const auto byte = std::to_integer<std::size_t>(bytes.front());
        bytes = bytes.subspan(1);
        number |= (byte & 127) << shift;
        if (byte < 128)
            return true;
    }
    return false;
}

/// zstd's working memory, one for each thread: making it takes longer than a small tile.
ZSTD_CCtx& compressor() {
    struct Free {
        void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
    };

    thread_local const std::unique_ptr<ZSTD_CCtx, Free> context(ZSTD_createCCtx());
    if (!context)
        throw std::bad_alloc();
    return *context;
}

ZSTD_DCtx& decompressor() {
    struct Free {
        void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
    };

    thread_local const std::unique_ptr<ZSTD_DCtx, Free> context(ZSTD_createDCtx());
    if (!context)
        throw std::bad_alloc();
    return *context;
}

void append_stream(std::vector<std::byte>& bytes, const std::vector<std::uint8_t>& stream) {
    // The highest before those that zstd calls ultra, which take more memory.
    constexpr int level = 19;
    append_number(bytes, stream.size());
    if (stream.empty())
        return;
    std::vector<std::byte> frame(ZSTD_compressBound(stream.size()));
    const std::size_t size = ZSTD_compressCCtx(
        &compressor(), frame.data(), frame.size(), stream.data(), stream.size(), level);
    if (ZSTD_isError(size) != 0)
        throw std::runtime_error(
            std::string("cannot compress a picture: zstd: ") + ZSTD_getErrorName(size));
    if (size < stream.size()) {
        append_number(bytes, size);
        bytes.insert(bytes.end(), frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size));
    } else {
        append_number(bytes, stream.size());
        const auto plain = std::as_bytes(std::span(stream));
        bytes.insert(bytes.end(), plain.begin(), plain.end());
    }
}

bool take_stream(
    std::span<const std::byte>& bytes, std::size_t longest, std::vector<std::uint8_t>& stream) {
    std::size_t size = 0;
    std::size_t stored = 0;
    if (!take_number(bytes, size) || size > longest)
        return false;
    stream.resize(size);
    if (size == 0)
        return true;
    if (!take_number(bytes, stored) || stored > bytes.size() || stored > size)
        return false;
    const auto frame = bytes.first(stored);
    bytes = bytes.subspan(stored);
    if (stored == size) {
        std::memcpy(stream.data(), frame.data(), size);
        return true;
    }
    return ZSTD_decompressDCtx(
               &decompressor(), stream.data(), stream.size(), frame.data(), frame.size())
        == size;
}

} // namespace

std::vector<std::byte> packed(const TileStreams& streams) {
    std::vector<std::byte> bytes;
    append_number(bytes, streams.error);
    append_stream(bytes, streams.commands);
    append_stream(bytes, streams.lengths);
    for (const auto& values : streams.values)
        append_stream(bytes, values);
    return bytes;
}

bool unpack(std::span<const std::byte> bytes, std::size_t longest, TileStreams& streams) {
    std::size_t error = 0;
    if (!take_number(bytes, error))
        return false;
    streams.error = static_cast<unsigned>(error);
    if (!take_stream(bytes, longest, streams.commands)
        || !take_stream(bytes, longest, streams.lengths))
        return false;
    for (auto& values : streams.values)
        if (!take_stream(bytes, longest, values))
            return false;
    return bytes.empty();
}

} // namespace vera::detail
