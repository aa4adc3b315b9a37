// SPDX-License-Identifier: Apache-2.0
#include "vera/image/codecs.h"
#include "vera/image/exr_streams-inl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <memory>
#include <string>

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfCompression.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <half.h>

namespace vera::detail {

namespace {

constexpr std::array channels = {"R", "G", "B"};

Imf::Header header_for(const Image& image, const PictureMetadata& metadata, Imf::PixelType type) {
    Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const char* channel : channels)
        header.channels().insert(channel, Imf::Channel(type));
    // Those of sRGB, which are those of ITU-R BT.709 and OpenEXR's default.
    Imf::addChromaticities(header, Imf::Chromaticities());
    add_metadata(header, metadata);
    return header;
}

/// A frame buffer over rows of three samples side by side, the first pixel being (x, y) to OpenEXR.
Imf::FrameBuffer frame_buffer(
    const void* samples, Imf::PixelType type, std::size_t width, std::int64_t x, std::int64_t y) {
    const std::size_t sample_bytes = type == Imf::HALF ? 2 : 4;
    const std::size_t pixel_bytes = 3 * sample_bytes;
    const std::size_t row_bytes = pixel_bytes * width;
    Imf::FrameBuffer buffer;
    for (std::size_t i = 0; i < channels.size(); ++i) {
        // OpenEXR adds what is subtracted here. An address may wrap round on the way where a
        // pointer may not.
        const std::uintptr_t address = reinterpret_cast<std::uintptr_t>(samples) + i * sample_bytes
            - static_cast<std::uintptr_t>(x) * pixel_bytes
            - static_cast<std::uintptr_t>(y) * row_bytes;
        char* const base = reinterpret_cast<char*>(address); // NOLINT(performance-no-int-to-ptr)
        buffer.insert(channels[i], Imf::Slice(type, base, pixel_bytes, row_bytes));
    }
    return buffer;
}

/// The nearest number of 16 bits; what is too large for any becomes the largest, not infinite.
half nearest_half(float value) {
    const auto largest = static_cast<float>(HALF_MAX);
    return std::isfinite(value) ? std::clamp(value, -largest, largest) : value;
}

void encode_pixels(
    Imf::OStream& target, const Image& image, const PictureMetadata& metadata, ExrSamples samples) {
    const auto type = samples == ExrSamples::half ? Imf::HALF : Imf::FLOAT;
    Imf::OutputFile output(target, header_for(image, metadata, type), 0);
    const auto& floats = std::get<std::vector<float>>(image.samples);
    if (type == Imf::FLOAT) {
        output.setFrameBuffer(frame_buffer(floats.data(), type, image.width, 0, 0));
        output.writePixels(static_cast<int>(image.height));
        return;
    }
    constexpr std::size_t block = 16; // rows that OpenEXR compresses together
    std::vector<half> halves(3 * image.width * std::min(block, image.height));
    for (std::size_t y = 0; y < image.height; y += block) {
        const std::size_t rows = std::min(block, image.height - y);
        const auto first = floats.begin() + static_cast<std::ptrdiff_t>(3 * image.width * y);
        std::transform(
            first,
            first + static_cast<std::ptrdiff_t>(3 * image.width * rows),
            halves.begin(),
            nearest_half);
        output.setFrameBuffer(
            frame_buffer(halves.data(), type, image.width, 0, static_cast<std::int64_t>(y)));
        output.writePixels(static_cast<int>(rows));
    }
}

std::size_t side(int first, int last) {
    return static_cast<std::size_t>(std::int64_t{last} - first + 1);
}

/// How few bits stand for a pixel of three channels before they are deflated, or packed by less.
std::size_t pixel_bits(const Imf::Header& header) {
    const Imf::Compression compression = header.compression();
    // These lose what hardly shows, and keep of 64 pixels perhaps one number a channel.
    if (compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION)
        return 1;
    constexpr std::size_t smallest_sample = 16;
    return channels.size() * smallest_sample;
}

} // namespace

void write_exr(
    const Image& image, OutputFile& file, const PictureMetadata& metadata, ExrSamples samples) {
    check_exr_size(image.width, image.height, file);
    ExrTarget target(file);
    target.encode([&] { encode_pixels(target.stream(), image, metadata, samples); });
    target.finish();
}

Image read_exr(std::span<const std::byte> bytes, const std::string& name) {
    if (!exr_headers_fit(bytes))
        throw_damaged(name, "it ends before what its header promises");
    ExrSource source(bytes, name);
    std::unique_ptr<Imf::InputFile> input;
    try {
        input = std::make_unique<Imf::InputFile>(source, 0);
    } catch (const std::exception& error) {
        throw_damaged(name, error.what());
    }
    const Imath::Box2i window = input->header().dataWindow();
    const std::size_t width = side(window.min.x, window.max.x);
    const std::size_t height = side(window.min.y, window.max.y);
    for (const char* channel : channels)
        if (input->header().channels().findChannel(channel) == nullptr)
            throw_damaged(name, std::string("it has no channel ") + channel);
    check_plausible(width, height, pixel_bits(input->header()), bytes.size(), name);
    Image image = blank_image(width, height, SampleType::float32);
    const float* samples = std::get<std::vector<float>>(image.samples).data();
    try {
        input->setFrameBuffer(frame_buffer(samples, Imf::FLOAT, width, window.min.x, window.min.y));
        input->readPixels(window.min.y, window.max.y);
    } catch (const std::exception& error) {
        throw_damaged(name, error.what());
    }
    return image;
}

} // namespace vera::detail
