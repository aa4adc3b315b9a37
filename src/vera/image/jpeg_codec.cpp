// SPDX-License-Identifier: Apache-2.0
#include "vera/base/output_file.h"
#include "vera/image/codecs.h"

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>
#include <utility>

#include <jerror.h>
#include <jpeglib.h>

namespace vera::detail {

namespace {

// As for PNG: an error leaves libjpeg by longjmp, so that functions that call setjmp, and callbacks
// where they jump, hold plain values alone.

/// Its first member is what libjpeg knows of it.
struct Errors {
    jpeg_error_mgr manager = {};
    std::jmp_buf jump = {};
    std::array<char, JMSG_LENGTH_MAX> message = {};
};

[[noreturn]] void jump_out(j_common_ptr jpeg) {
    auto* errors = reinterpret_cast<Errors*>(jpeg->err);
    jpeg->err->format_message(jpeg, errors->message.data());
    std::longjmp(errors->jump, 1);
}

/// libjpeg calls damage a warning and goes on in grey: here it is an error. What remain are
/// oddities that harm no pixel.
void judge_message(j_common_ptr jpeg, int level) {
    if (level >= 0)
        return;
    switch (jpeg->err->msg_code) {
    case JWRN_EXTRANEOUS_DATA:
    case JWRN_JFIF_MAJOR:
    case JWRN_ADOBE_XFORM:
    case JWRN_TOO_MUCH_DATA:
        return;
    default:
        jump_out(jpeg);
    }
}

void print_nothing(j_common_ptr /*jpeg*/) {}

void set_up(Errors& errors, jpeg_error_mgr*& place) {
    place = jpeg_std_error(&errors.manager);
    errors.manager.error_exit = jump_out;
    errors.manager.emit_message = judge_message;
    errors.manager.output_message = print_nothing;
}

/// Where the bytes go. Its first member is what libjpeg knows of it.
struct Destination {
    jpeg_destination_mgr manager = {};
    OutputFile* file = nullptr;
    std::exception_ptr failure;
    std::array<JOCTET, 65536> buffer = {};
};

void reset(Destination& destination) {
    destination.manager.next_output_byte = destination.buffer.data();
    destination.manager.free_in_buffer = destination.buffer.size();
}

void begin_output(j_compress_ptr jpeg) {
    reset(*reinterpret_cast<Destination*>(jpeg->dest));
}

void write_bytes(j_compress_ptr jpeg, std::size_t count) {
    auto* destination = reinterpret_cast<Destination*>(jpeg->dest);
    try {
        destination->file->write(
            std::as_bytes(std::span(std::as_const(destination->buffer)).first(count)));
    } catch (...) {
        destination->failure = std::current_exception();
    }
    if (destination->failure)
        jump_out(reinterpret_cast<j_common_ptr>(jpeg));
    reset(*destination);
}

boolean write_full_buffer(j_compress_ptr jpeg) {
    // The whole buffer, whatever free_in_buffer says: so libjpeg defines it.
    write_bytes(jpeg, reinterpret_cast<Destination*>(jpeg->dest)->buffer.size());
    return TRUE;
}

void end_output(j_compress_ptr jpeg) {
    const auto* destination = reinterpret_cast<Destination*>(jpeg->dest);
    write_bytes(jpeg, destination->buffer.size() - destination->manager.free_in_buffer);
}

struct Compressor {
    jpeg_compress_struct jpeg = {};

    Compressor() = default;

    ~Compressor() { jpeg_destroy_compress(&jpeg); }

    Compressor(const Compressor&) = delete;
    Compressor& operator=(const Compressor&) = delete;
};

struct Decompressor {
    jpeg_decompress_struct jpeg = {};

    Decompressor() = default;

    ~Decompressor() { jpeg_destroy_decompress(&jpeg); }

    Decompressor(const Decompressor&) = delete;
    Decompressor& operator=(const Decompressor&) = delete;
};

bool encode(
    jpeg_compress_struct& jpeg,
    Errors& errors,
    Destination& destination,
    const Image& image,
    const std::vector<std::string>& comments,
    int quality) noexcept {
    if (setjmp(errors.jump) != 0)
        return false;
    jpeg_create_compress(&jpeg);
    jpeg.dest = &destination.manager;
    jpeg.image_width = static_cast<JDIMENSION>(image.width);
    jpeg.image_height = static_cast<JDIMENSION>(image.height);
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, quality, TRUE);
    // The integer transform: the same bits with every instruction set.
    jpeg.dct_method = JDCT_ISLOW;
    for (int i = 0; i < 3; ++i) {
        jpeg.comp_info[i].h_samp_factor = 1;
        jpeg.comp_info[i].v_samp_factor = 1;
    }
    jpeg_start_compress(&jpeg, TRUE);
    for (const std::string& comment : comments)
        jpeg_write_marker(
            &jpeg,
            JPEG_COM,
            reinterpret_cast<const JOCTET*>(comment.data()),
            static_cast<unsigned>(comment.size()));
    const auto* samples = std::get_if<std::vector<std::uint8_t>>(&image.samples);
    while (jpeg.next_scanline < jpeg.image_height) {
        // libjpeg does not write to the row.
        auto* row = const_cast<JSAMPROW>(samples->data() + 3 * image.width * jpeg.next_scanline);
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    return true;
}

/// A small file may ask for a large picture to be gone over time and again.
void limit_scans(j_common_ptr jpeg) {
    constexpr int most_scans = 200;
    if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number <= most_scans)
        return;
    auto* errors = reinterpret_cast<Errors*>(jpeg->err);
    std::strcpy(errors->message.data(), "it has more scans than a picture needs");
    std::longjmp(errors->jump, 1);
}

bool decode_header(
    jpeg_decompress_struct& jpeg, Errors& errors, std::span<const std::byte> bytes) noexcept {
    if (setjmp(errors.jump) != 0)
        return false;
    jpeg_create_decompress(&jpeg);
    jpeg_mem_src(
        &jpeg,
        reinterpret_cast<const unsigned char*>(bytes.data()),
        static_cast<unsigned long>(bytes.size()));
    jpeg_read_header(&jpeg, TRUE);
    jpeg.out_color_space = JCS_RGB;
    jpeg.dct_method = JDCT_ISLOW;
    return true;
}

bool decode_pixels(
    jpeg_decompress_struct& jpeg,
    jpeg_progress_mgr& progress,
    Errors& errors,
    std::uint8_t* first) noexcept {
    if (setjmp(errors.jump) != 0)
        return false;
    jpeg.progress = &progress;
    jpeg_start_decompress(&jpeg);
    while (jpeg.output_scanline < jpeg.output_height) {
        JSAMPROW row = first + std::size_t{3} * jpeg.output_width * jpeg.output_scanline;
        jpeg_read_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_decompress(&jpeg);
    return true;
}

/// "name: value", in as many pieces as it takes: a comment holds less than 64 kilobytes.
std::vector<std::string> comments(const PictureMetadata& metadata) {
    constexpr std::size_t longest = 65533;
    std::vector<std::string> pieces;
    for (const auto& [name, value] : metadata) {
        const std::string text = plain_name(name, name.size()) + ": " + value;
        for (std::size_t start = 0; start < text.size(); start += longest)
            pieces.push_back(text.substr(start, longest));
    }
    return pieces;
}

} // namespace

void write_jpeg(
    const Image& image,
    OutputFile& file,
    const PictureMetadata& metadata,
    const ImageWriteSettings& settings) {
    if (image.width > JPEG_MAX_DIMENSION || image.height > JPEG_MAX_DIMENSION)
        throw std::runtime_error(
            "cannot write " + file.name()
            + ": a JPEG picture has at most 65500 pixels a side; choose PNG or EXR");
    const auto destination = std::make_unique<Destination>();
    destination->file = &file;
    destination->manager.init_destination = begin_output;
    destination->manager.empty_output_buffer = write_full_buffer;
    destination->manager.term_destination = end_output;
    Errors errors;
    Compressor compressor;
    set_up(errors, compressor.jpeg.err);
    const int quality = std::clamp(settings.jpeg_quality, 1, 100);
    if (encode(compressor.jpeg, errors, *destination, image, comments(metadata), quality))
        return;
    if (destination->failure)
        std::rethrow_exception(destination->failure);
    throw std::runtime_error("cannot write " + file.name() + ": libjpeg: " + errors.message.data());
}

Image read_jpeg(std::span<const std::byte> bytes, const std::string& name) {
    Errors errors;
    Decompressor decompressor;
    set_up(errors, decompressor.jpeg.err);
    if (!decode_header(decompressor.jpeg, errors, bytes))
        throw_damaged(name, errors.message.data());
    const std::size_t width = decompressor.jpeg.image_width;
    const std::size_t height = decompressor.jpeg.image_height;
    // One colour everywhere takes 6 bits for 256 pixels, and fewer in a progressive picture.
    constexpr std::size_t pixel_bits = 8;
    check_plausible(width, height, pixel_bits, bytes.size(), name);
    Image image = blank_image(width, height, SampleType::integer8);
    jpeg_progress_mgr progress = {};
    progress.progress_monitor = limit_scans;
    auto* first = std::get<std::vector<std::uint8_t>>(image.samples).data();
    if (!decode_pixels(decompressor.jpeg, progress, errors, first))
        throw_damaged(name, errors.message.data());
    return image;
}

} // namespace vera::detail
