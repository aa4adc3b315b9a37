// SPDX-License-Identifier: Apache-2.0
#include "vera/base/output_file.h"
#include "vera/image/codecs.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfCompression.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <half.h>

namespace vera::detail {

namespace {

constexpr std::array channels = {"R", "G", "B"};

/// Takes what OpenEXR writes, which goes back at the end to fill in where each block of rows lies.
/// OpenEXR swallows an error of that last step: it is kept here.
class ExrTarget : public Imf::OStream {
public:
    explicit ExrTarget(const std::string& name)
        : Imf::OStream(name.c_str()) {}

    void write(const char* data, int count) override {
        const auto bytes = std::as_bytes(std::span(data, static_cast<std::size_t>(count)));
        try {
            if (position_ == size_) {
                append(bytes);
                size_ += bytes.size();
            } else {
                overwrite(position_, bytes);
                size_ = std::max(size_, position_ + bytes.size());
            }
        } catch (...) {
            if (!failure_)
                failure_ = std::current_exception();
            throw;
        }
        position_ += bytes.size();
    }

    std::uint64_t tellp() override { return position_; }

    void seekp(std::uint64_t position) override { position_ = position; }

    void throw_if_failed() const {
        if (failure_)
            std::rethrow_exception(failure_);
    }

protected:
    virtual void append(std::span<const std::byte> bytes) = 0;
    virtual void overwrite(std::uint64_t position, std::span<const std::byte> bytes) = 0;

private:
    std::uint64_t position_ = 0;
    std::uint64_t size_ = 0;
    std::exception_ptr failure_;
};

class SeekableTarget : public ExrTarget {
public:
    explicit SeekableTarget(OutputFile& file)
        : ExrTarget(file.name())
        , file_(file) {}

private:
    void append(std::span<const std::byte> bytes) override { file_.write(bytes); }

    void overwrite(std::uint64_t position, std::span<const std::byte> bytes) override {
        file_.write_at(position, bytes);
    }

    OutputFile& file_;
};

/// For a pipe, which cannot go back: everything waits in a file without a name.
class SpooledTarget : public ExrTarget {
public:
    explicit SpooledTarget(const std::string& name)
        : ExrTarget(name)
        , spool_(std::tmpfile()) {
        if (spool_ == nullptr)
            fail();
    }

    ~SpooledTarget() override {
        if (spool_ != nullptr)
            std::fclose(spool_);
    }

    SpooledTarget(const SpooledTarget&) = delete;
    SpooledTarget& operator=(const SpooledTarget&) = delete;

    void copy_to(OutputFile& file) {
        std::rewind(spool_);
        std::vector<std::byte> buffer(std::size_t{1} << 16);
        while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), spool_))
            file.write(std::span(buffer).first(count));
        if (std::ferror(spool_) != 0)
            fail();
    }

private:
    void append(std::span<const std::byte> bytes) override {
        if (std::fseek(spool_, 0, SEEK_END) != 0)
            fail();
        put(bytes);
    }

    void overwrite(std::uint64_t position, std::span<const std::byte> bytes) override {
        if (std::fseek(spool_, static_cast<long>(position), SEEK_SET) != 0)
            fail();
        put(bytes);
    }

    void put(std::span<const std::byte> bytes) {
        if (std::fwrite(bytes.data(), 1, bytes.size(), spool_) != bytes.size())
            fail();
    }

    [[noreturn]] void fail() const {
        throw std::system_error(
            errno,
            std::generic_category(),
            std::string("cannot write ") + fileName()
                + "; an EXR picture waits in the folder for temporary files when it goes to a "
                  "pipe");
    }

    std::FILE* spool_;
};

class ExrSource : public Imf::IStream {
public:
    ExrSource(std::span<const std::byte> bytes, const std::string& name)
        : Imf::IStream(name.c_str())
        , bytes_(bytes) {}

    bool read(char* data, int count) override {
        const auto size = static_cast<std::size_t>(count);
        if (count < 0 || position_ > bytes_.size() || bytes_.size() - position_ < size)
            throw std::runtime_error("it ends early");
        std::memcpy(data, bytes_.data() + position_, size);
        position_ += size;
        return position_ < bytes_.size();
    }

    std::uint64_t tellg() override { return position_; }

    void seekg(std::uint64_t position) override { position_ = position; }

private:
    std::span<const std::byte> bytes_;
    std::uint64_t position_ = 0;
};

Imf::Header header_for(const Image& image, const PictureMetadata& metadata, Imf::PixelType type) {
    Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const char* channel : channels)
        header.channels().insert(channel, Imf::Channel(type));
    // Those of sRGB, which are those of ITU-R BT.709 and OpenEXR's default.
    Imf::addChromaticities(header, Imf::Chromaticities());
    constexpr std::size_t longest_name = 255;
    for (const auto& [name, value] : metadata) {
        std::string attribute = plain_name(name, longest_name);
        // A name that OpenEXR uses for something else would change the picture.
        while (header.find(attribute.c_str()) != header.end())
            attribute.insert(0, "vera_");
        header.insert(attribute.c_str(), Imf::StringAttribute(value));
    }
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

void encode(
    ExrTarget& target, const Image& image, const PictureMetadata& metadata, ExrSamples samples) {
    try {
        encode_pixels(target, image, metadata, samples);
    } catch (const std::exception& error) {
        // OpenEXR has given errors of ours other words.
        target.throw_if_failed();
        throw std::runtime_error(
            std::string("cannot write ") + target.fileName() + ": " + error.what());
    }
    target.throw_if_failed();
}

std::size_t side(int first, int last) {
    return static_cast<std::size_t>(std::int64_t{last} - first + 1);
}

/// Walks over the headers of an EXR file, as far as to tell whether OpenEXR may be let read them:
/// it makes room for what they promise before it sees how long the file is.
class ExrHeaders {
public:
    explicit ExrHeaders(std::span<const std::byte> bytes)
        : rest_(bytes) {}

    /// Whether every attribute ends within the file, and the tables of where its rows or tiles lie
    /// could.
    bool fit() {
        constexpr std::size_t magic_and_version = 8;
        return skip(magic_and_version) && attributes_fit() && tables_fit();
    }

private:
    using Sides = std::array<std::int64_t, 2>;

    bool attributes_fit() {
        // Headers of several parts follow one another, and an empty one ends them.
        while (true) {
            const std::optional<std::string> name = text();
            if (!name)
                return false;
            if (name->empty())
                return true;
            const std::optional<std::string> type = text();
            if (!type || rest_.size() < 4)
                return false;
            const std::int32_t size = number_at(0);
            skip(4);
            if (size < 0 || static_cast<std::size_t>(size) > rest_.size())
                return false;
            if (*name == "dataWindow" && size >= 16)
                window_ = {
                    std::int64_t{number_at(8)} - number_at(0) + 1,
                    std::int64_t{number_at(12)} - number_at(4) + 1};
            if (*name == "tiles" && size >= 8)
                tile_ = {number_at(0), number_at(4)};
            skip(static_cast<std::size_t>(size));
        }
    }

    bool tables_fit() const {
        constexpr std::int64_t most_rows_of_a_block = 256;
        constexpr std::size_t entry = 8;
        const Sides block = tile_.value_or(Sides{window_[0], most_rows_of_a_block});
        const auto most = static_cast<std::int64_t>(rest_.size() / entry) + 1;
        std::int64_t blocks = 1;
        for (std::size_t i = 0; i < 2; ++i) {
            if (window_[i] <= 0 || block[i] <= 0)
                return true; // OpenEXR complains
            const std::int64_t along = (window_[i] - 1) / block[i] + 1;
            if (along > most)
                return false;
            blocks *= along;
        }
        return blocks <= most;
    }

    bool skip(std::size_t count) {
        if (count > rest_.size())
            return false;
        rest_ = rest_.subspan(count);
        return true;
    }

    /// Up to a byte 0, which is skipped.
    std::optional<std::string> text() {
        const auto end = std::find(rest_.begin(), rest_.end(), std::byte{0});
        if (end == rest_.end())
            return std::nullopt;
        const auto length = static_cast<std::size_t>(end - rest_.begin());
        std::string result(length, '\0');
        std::memcpy(result.data(), rest_.data(), length);
        skip(length + 1);
        return result;
    }

    std::int32_t number_at(std::size_t offset) const {
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < 4; ++i)
            bits |= std::to_integer<std::uint32_t>(rest_[offset + i]) << (8 * i);
        return static_cast<std::int32_t>(bits);
    }

    std::span<const std::byte> rest_;
    Sides window_ = {1, 1};
    std::optional<Sides> tile_;
};

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
    constexpr auto largest_side = static_cast<std::size_t>(std::numeric_limits<int>::max() / 16);
    if (image.width > largest_side || image.height > largest_side)
        throw std::runtime_error(
            "cannot write " + file.name() + ": an EXR picture has at most 134217727 pixels a side");
    if (file.seekable()) {
        SeekableTarget target(file);
        encode(target, image, metadata, samples);
    } else {
        SpooledTarget target(file.name());
        encode(target, image, metadata, samples);
        target.copy_to(file);
    }
}

Image read_exr(std::span<const std::byte> bytes, const std::string& name) {
    if (!ExrHeaders(bytes).fit())
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
