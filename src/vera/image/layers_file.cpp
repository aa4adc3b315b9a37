// SPDX-License-Identifier: Apache-2.0
#include "vera/image/layers_file.h"

#include "vera/base/check.h"
#include "vera/image/codecs.h"
#include "vera/image/exr_streams-inl.h"

#include <cstdint>
#include <optional>
#include <stdexcept>

#include <ImfChannelList.h>
#include <ImfCompression.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

namespace vera {

namespace {

constexpr std::size_t word_bytes = 4;

Imf::PixelType pixel_type(LayerChannel::Type type) {
    return type == LayerChannel::Type::float32 ? Imf::FLOAT : Imf::UINT;
}

/// A channel's samples side by side, rows of that width one after another, the first sample being
/// (x, y) to OpenEXR.
Imf::Slice
slice(const void* samples, Imf::PixelType type, std::size_t width, std::int64_t x, std::int64_t y) {
    // OpenEXR adds what is subtracted here. An address may wrap round on the way where a pointer
    // may not.
    const std::uintptr_t address = reinterpret_cast<std::uintptr_t>(samples)
        - static_cast<std::uintptr_t>(x) * word_bytes
        - static_cast<std::uintptr_t>(y) * width * word_bytes;
    char* const base = reinterpret_cast<char*>(address); // NOLINT(performance-no-int-to-ptr)
    return {type, base, word_bytes, word_bytes * width};
}

/// How few bits stand for a pixel before they are deflated, or packed by less.
std::size_t pixel_bits(const Imf::Header& header) {
    // These lose what hardly shows, and keep of 64 pixels perhaps one number a channel.
    if (header.compression() == Imf::DWAA_COMPRESSION
        || header.compression() == Imf::DWAB_COMPRESSION)
        return 1;
    constexpr std::size_t smallest_sample = 16;
    std::size_t bits = 0;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
        bits += smallest_sample;
    return bits;
}

} // namespace

struct LayersWriter::Encoder {
    Encoder(OutputFile& file, std::size_t picture_width, std::vector<LayerChannel> picture_channels)
        : target(file)
        , width(picture_width)
        , channels(std::move(picture_channels)) {}

    detail::ExrTarget target;
    std::size_t width;
    std::vector<LayerChannel> channels;
    std::size_t next_row = 0;
    std::optional<Imf::OutputFile> output;
};

LayersWriter::LayersWriter(
    OutputFile& file,
    std::size_t width,
    std::size_t height,
    std::vector<LayerChannel> channels,
    const PictureMetadata& metadata)
    : encoder_(std::make_unique<Encoder>(file, width, std::move(channels))) {
    detail::check_exr_size(width, height, file);
    Imf::Header header(static_cast<int>(width), static_cast<int>(height));
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const LayerChannel& channel : encoder_->channels)
        header.channels().insert(channel.name, Imf::Channel(pixel_type(channel.type)));
    detail::add_metadata(header, metadata);
    encoder_->target.encode(
        [&] { encoder_->output.emplace(encoder_->target.stream(), header, 0); });
}

LayersWriter::~LayersWriter() = default;

void LayersWriter::write_rows(std::size_t rows, std::span<const std::uint32_t> words) {
    Encoder& encoder = *encoder_;
    const std::size_t plane = rows * encoder.width;
    VERA_CHECK(words.size() == encoder.channels.size() * plane);
    Imf::FrameBuffer buffer;
    for (std::size_t i = 0; i < encoder.channels.size(); ++i)
        buffer.insert(
            encoder.channels[i].name,
            slice(
                words.data() + i * plane,
                pixel_type(encoder.channels[i].type),
                encoder.width,
                0,
                static_cast<std::int64_t>(encoder.next_row)));
    encoder.target.encode([&] {
        encoder.output->setFrameBuffer(buffer);
        encoder.output->writePixels(static_cast<int>(rows));
    });
    encoder.next_row += rows;
}

void LayersWriter::finish() {
    // Where each block of rows lies is written last.
    encoder_->target.encode([&] { encoder_->output.reset(); });
    encoder_->target.finish();
}

struct LayersReader::Decoder {
    Decoder(std::span<const std::byte> bytes, const std::string& file_name)
        : name(file_name)
        , source(bytes, file_name) {
        try {
            input.emplace(source, 0);
        } catch (const std::exception& error) {
            detail::throw_damaged(name, error.what());
        }
    }

    std::string name;
    detail::ExrSource source;
    std::optional<Imf::InputFile> input;
};

LayersReader::LayersReader(std::span<const std::byte> bytes, const std::string& name) {
    if (!detail::exr_headers_fit(bytes))
        detail::throw_damaged(name, "it ends before what its header promises");
    decoder_ = std::make_unique<Decoder>(bytes, name);
    const Imf::Header& header = decoder_->input->header();
    const auto side = [](int first, int last) {
        return static_cast<std::size_t>(std::int64_t{last} - first + 1);
    };
    const Imath::Box2i window = header.dataWindow();
    width_ = side(window.min.x, window.max.x);
    height_ = side(window.min.y, window.max.y);
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
        if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
            detail::throw_damaged(
                name, std::string("its channel ") + channel.name() + " leaves pixels out");
        channels_.push_back(
            {channel.name(),
             channel.channel().type == Imf::UINT ? LayerChannel::Type::uint32
                                                 : LayerChannel::Type::float32});
    }
    if (channels_.empty())
        detail::throw_damaged(name, "it has no channels");
    detail::check_plausible(width_, height_, pixel_bits(header), bytes.size(), name);
}

LayersReader::~LayersReader() = default;

std::string LayersReader::text(const std::string& attribute) const {
    const auto* const found =
        decoder_->input->header().findTypedAttribute<Imf::StringAttribute>(attribute);
    return found == nullptr ? std::string() : found->value();
}

void LayersReader::read_row(
    std::size_t y, std::span<const std::string> channels, std::span<float> samples) const {
    VERA_CHECK(y < height_ && samples.size() == channels.size() * width_);
    Imf::InputFile& input = *decoder_->input;
    const Imath::Box2i window = input.header().dataWindow();
    const std::int64_t row = window.min.y + static_cast<std::int64_t>(y);
    Imf::FrameBuffer buffer;
    for (std::size_t i = 0; i < channels.size(); ++i)
        buffer.insert(
            channels[i], slice(samples.data() + i * width_, Imf::FLOAT, width_, window.min.x, row));
    try {
        input.setFrameBuffer(buffer);
        input.readPixels(static_cast<int>(row), static_cast<int>(row));
    } catch (const std::exception& error) {
        detail::throw_damaged(decoder_->name, error.what());
    }
}

} // namespace vera
