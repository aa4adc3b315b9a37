// SPDX-License-Identifier: Apache-2.0
#include "vera/base/output_file.h"
#include "vera/image/codecs.h"
#include "vera/image/indexed_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>

#include <png.h>

namespace vera::detail {

namespace {

/// What the callbacks of libpng work on. An error leaves libpng by longjmp, which must not pass
/// over anything that has a destructor: functions that call setjmp, and callbacks where they jump,
/// hold plain values alone. An exception of ours is kept here meanwhile.
struct Stream {
    OutputFile* file = nullptr;
    std::span<const std::byte> unread;
    std::exception_ptr failure;
    std::array<char, 200> message = {};
};

void keep_error(png_structp png, png_const_charp message) {
    auto* stream = static_cast<Stream*>(png_get_error_ptr(png));
    std::strncpy(stream->message.data(), message, stream->message.size() - 1);
    png_longjmp(png, 1);
}

void ignore_warning(png_structp /*png*/, png_const_charp /*message*/) {}

void write_bytes(png_structp png, png_bytep data, std::size_t size) {
    auto* stream = static_cast<Stream*>(png_get_io_ptr(png));
    try {
        stream->file->write(std::as_bytes(std::span(data, size)));
    } catch (...) {
        stream->failure = std::current_exception();
    }
    if (stream->failure)
        png_error(png, "");
}

void flush_nothing(png_structp /*png*/) {}

void read_bytes(png_structp png, png_bytep data, std::size_t size) {
    auto* stream = static_cast<Stream*>(png_get_io_ptr(png));
    if (stream->unread.size() < size)
        png_error(png, "it ends early");
    std::memcpy(data, stream->unread.data(), size);
    stream->unread = stream->unread.subspan(size);
}

/// libpng's own data, given back at the end.
struct Writer {
    png_structp png = nullptr;
    png_infop info = nullptr;

    explicit Writer(Stream& stream)
        : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, &stream, keep_error, ignore_warning))
        , info(png == nullptr ? nullptr : png_create_info_struct(png)) {
        if (info == nullptr) {
            png_destroy_write_struct(&png, nullptr);
            throw std::bad_alloc();
        }
        png_set_write_fn(png, &stream, write_bytes, flush_nothing);
    }

    ~Writer() { png_destroy_write_struct(&png, &info); }

    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;
};

struct Reader {
    png_structp png = nullptr;
    png_infop info = nullptr;

    explicit Reader(Stream& stream)
        : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &stream, keep_error, ignore_warning))
        , info(png == nullptr ? nullptr : png_create_info_struct(png)) {
        if (info == nullptr) {
            png_destroy_read_struct(&png, nullptr, nullptr);
            throw std::bad_alloc();
        }
        png_set_read_fn(png, &stream, read_bytes);
    }

    ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }

    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;
};

/// The metadata as libpng takes it, pointing into names and values that outlive it.
struct TextChunks {
    std::vector<std::string> names;
    std::vector<png_text> chunks;

    explicit TextChunks(const PictureMetadata& metadata) {
        constexpr std::size_t longest_name = 79;
        names.reserve(metadata.size());
        for (const auto& [name, value] : metadata) {
            names.push_back(plain_name(name, longest_name));
            const bool ascii = std::all_of(value.begin(), value.end(), [](char letter) {
                return static_cast<unsigned char>(letter) < 128;
            });
            png_text chunk = {};
            // tEXt holds Latin-1, iTXt UTF-8.
            chunk.compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
            chunk.key = names.back().data();
            // libpng does not write to it.
            chunk.text = const_cast<char*>(value.c_str());
            chunks.push_back(chunk);
        }
    }
};

struct Rows {
    const unsigned char* first;
    std::size_t row_bytes;
    png_uint_32 width;
    png_uint_32 height;
    int bit_depth;
    int compression;
};

/// How much the bytes differ from others, each by itself.
std::uint64_t
difference(const unsigned char* bytes, const unsigned char* others, std::size_t size) {
    std::uint64_t sum = 0;
    constexpr std::size_t part = std::size_t{1} << 16; // of which the sum fits into 32 bits
    for (std::size_t first = 0; first < size; first += part) {
        const std::size_t end = std::min(first + part, size);
        int part_sum = 0; // so that compilers find the instruction that sums up differences
        for (std::size_t i = first; i < end; ++i)
            part_sum += std::abs(int{bytes[i]} - int{others[i]});
        sum += static_cast<std::uint64_t>(part_sum);
    }
    return sum;
}

/// The filter by which the row's bytes get smaller: differences from the pixel to the left, or from
/// the one above, which there is. libpng would make both rows to see it, which takes several times
/// as long.
int better_filter(const Rows& rows, std::size_t y) {
    const unsigned char* const row = rows.first + y * rows.row_bytes;
    const std::size_t pixel = rows.row_bytes / rows.width;
    std::uint64_t from_left = difference(row + pixel, row, rows.row_bytes - pixel);
    for (std::size_t i = 0; i < pixel; ++i)
        from_left += static_cast<std::uint64_t>(std::min<int>(row[i], 256 - row[i]));
    const std::uint64_t from_above = difference(row, row - rows.row_bytes, rows.row_bytes);
    return from_above < from_left ? PNG_FILTER_UP : PNG_FILTER_SUB;
}

/// False when libpng has met an error.
bool encode(const Writer& writer, const Rows& rows, const std::vector<png_text>& texts) noexcept {
    png_structp png = writer.png;
    if (setjmp(png_jmpbuf(png)) != 0)
        return false;
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_compression_level(png, rows.compression);
    // With these two only files grow no larger than with all.
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB | PNG_FILTER_UP);
    png_set_compression_buffer_size(png, std::size_t{1} << 16);
    png_set_IHDR(
        png,
        writer.info,
        rows.width,
        rows.height,
        rows.bit_depth,
        PNG_COLOR_TYPE_RGB,
        PNG_INTERLACE_NONE,
        PNG_COMPRESSION_TYPE_DEFAULT,
        PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (!texts.empty())
        png_set_text(png, writer.info, texts.data(), static_cast<int>(texts.size()));
    png_write_info(png, writer.info);
    if (rows.bit_depth == 16 && std::endian::native == std::endian::little)
        png_set_swap(png);
    for (std::size_t y = 0; y < rows.height; ++y) {
        if (y > 0) // From the first row libpng takes what rows it has to keep.
            png_set_filter(png, PNG_FILTER_TYPE_BASE, better_filter(rows, y));
        png_write_row(png, rows.first + y * rows.row_bytes);
    }
    png_write_end(png, nullptr);
    return true;
}

/// The next row's numbers; false when there is none, since something was thrown, which is kept.
bool next_row(const IndexedPicture& picture, std::span<std::uint8_t> row, Stream& stream) noexcept {
    try {
        picture.next_row(row);
        return true;
    } catch (...) {
        stream.failure = std::current_exception();
        return false;
    }
}

bool encode_indexed(
    const Writer& writer,
    const IndexedPicture& picture,
    std::span<std::uint8_t> row,
    std::span<const png_color> colors,
    const std::vector<png_text>& texts,
    Stream& stream) noexcept {
    png_structp png = writer.png;
    if (setjmp(png_jmpbuf(png)) != 0)
        return false;
    constexpr int compression = 9;
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_compression_level(png, compression);
    // Numbers of colours are no amounts: differences of them mean nothing.
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
    int bits = 1;
    while (colors.size() > std::size_t{1} << bits)
        bits *= 2;
    png_set_IHDR(
        png,
        writer.info,
        static_cast<png_uint_32>(picture.width),
        static_cast<png_uint_32>(picture.height),
        bits,
        PNG_COLOR_TYPE_PALETTE,
        PNG_INTERLACE_NONE,
        PNG_COMPRESSION_TYPE_DEFAULT,
        PNG_FILTER_TYPE_DEFAULT);
    png_set_PLTE(png, writer.info, colors.data(), static_cast<int>(colors.size()));
    png_set_sRGB_gAMA_and_cHRM(png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (!texts.empty())
        png_set_text(png, writer.info, texts.data(), static_cast<int>(texts.size()));
    png_write_info(png, writer.info);
    png_set_packing(png);
    for (std::size_t y = 0; y < picture.height; ++y) {
        if (!next_row(picture, row, stream))
            return false;
        png_write_row(png, row.data());
    }
    png_write_end(png, nullptr);
    return true;
}

struct Header {
    png_uint_32 width = 0;
    png_uint_32 height = 0;
    int bit_depth = 0;
    std::size_t stored_bits = 0; ///< of a pixel
};

/// Reads up to the pixels, and has them turned into red, green and blue of 8 or 16 bits.
bool decode_header(const Reader& reader, Header& header) noexcept {
    png_structp png = reader.png;
    if (setjmp(png_jmpbuf(png)) != 0)
        return false;
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_read_info(png, reader.info);
    header.width = png_get_image_width(png, reader.info);
    header.height = png_get_image_height(png, reader.info);
    header.bit_depth = png_get_bit_depth(png, reader.info) == 16 ? 16 : 8;
    header.stored_bits =
        std::size_t{png_get_bit_depth(png, reader.info)} * png_get_channels(png, reader.info);
    png_set_expand(png);
    png_set_gray_to_rgb(png);
    png_set_strip_alpha(png);
    if (header.bit_depth == 16 && std::endian::native == std::endian::little)
        png_set_swap(png);
    return true;
}

bool decode_pixels(const Reader& reader, const Header& header, unsigned char* first) noexcept {
    png_structp png = reader.png;
    if (setjmp(png_jmpbuf(png)) != 0)
        return false;
    const int passes = png_set_interlace_handling(png);
    png_read_update_info(png, reader.info);
    const std::size_t row_bytes = 3 * static_cast<std::size_t>(header.bit_depth / 8) * header.width;
    if (png_get_rowbytes(png, reader.info) != row_bytes)
        png_error(png, "its pixels are of no known kind");
    for (int pass = 0; pass < passes; ++pass)
        for (std::size_t y = 0; y < header.height; ++y)
            png_read_row(png, first + y * row_bytes, nullptr);
    png_read_end(png, nullptr);
    return true;
}

void check_sides(std::size_t width, std::size_t height, const OutputFile& file) {
    if (width > PNG_UINT_31_MAX || height > PNG_UINT_31_MAX)
        throw std::runtime_error(
            "cannot write " + file.name() + ": a PNG picture has at most 2147483647 pixels a side");
}

[[noreturn]] void throw_failure(const Stream& stream, const OutputFile& file) {
    if (stream.failure)
        std::rethrow_exception(stream.failure);
    throw std::runtime_error("cannot write " + file.name() + ": libpng: " + stream.message.data());
}

} // namespace

void write_png(
    const Image& image,
    OutputFile& file,
    const PictureMetadata& metadata,
    const ImageWriteSettings& settings) {
    check_sides(image.width, image.height, file);
    const std::size_t sample_bytes = size_of(sample_type(image));
    const Rows rows = {
        std::visit(
            [](const auto& samples) {
                return reinterpret_cast<const unsigned char*>(samples.data());
            },
            image.samples),
        3 * sample_bytes * image.width,
        static_cast<png_uint_32>(image.width),
        static_cast<png_uint_32>(image.height),
        static_cast<int>(8 * sample_bytes),
        std::clamp(settings.png_compression, 0, 9)};
    Stream stream = {.file = &file, .unread = {}, .failure = {}};
    const Writer writer(stream);
    const TextChunks texts(metadata);
    if (!encode(writer, rows, texts.chunks))
        throw_failure(stream, file);
}

Image read_png(std::span<const std::byte> bytes, const std::string& name) {
    Stream stream = {.file = nullptr, .unread = bytes, .failure = {}};
    const Reader reader(stream);
    Header header;
    if (!decode_header(reader, header))
        throw_damaged(name, stream.message.data());
    check_plausible(header.width, header.height, header.stored_bits, bytes.size(), name);
    Image image = blank_image(
        header.width,
        header.height,
        header.bit_depth == 16 ? SampleType::integer16 : SampleType::integer8);
    auto* first = std::visit(
        [](auto& samples) { return reinterpret_cast<unsigned char*>(samples.data()); },
        image.samples);
    if (!decode_pixels(reader, header, first))
        throw_damaged(name, stream.message.data());
    return image;
}

} // namespace vera::detail

namespace vera {

void write_indexed_png(
    const IndexedPicture& picture, OutputFile& file, const PictureMetadata& metadata) {
    detail::check_sides(picture.width, picture.height, file);
    std::vector<png_color> colors;
    for (const auto& [red, green, blue] : picture.palette)
        colors.push_back({red, green, blue});
    std::vector<std::uint8_t> row(picture.width);
    detail::Stream stream = {.file = &file, .unread = {}, .failure = {}};
    const detail::Writer writer(stream);
    const detail::TextChunks texts(metadata);
    if (!detail::encode_indexed(writer, picture, row, colors, texts.chunks, stream))
        detail::throw_failure(stream, file);
}

} // namespace vera
