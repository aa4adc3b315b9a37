// SPDX-License-Identifier: Apache-2.0
// The formats of the netpbm family: PPM (integers) and PFM (floats).
#include "vera/base/output_file.h"
#include "vera/image/codecs.h"

#include <bit>
#include <charconv>
#include <cstring>
#include <string_view>

#include <fmt/format.h>

namespace vera::detail {

namespace {

template <typename Sample>
std::span<const Sample> row_of(const Image& image, std::size_t y) {
    const auto& samples = std::get<std::vector<Sample>>(image.samples);
    return std::span(samples).subspan(3 * image.width * y, 3 * image.width);
}

/// Lines "# name: value"; a value of several lines gets several.
std::string comments(const PictureMetadata& metadata) {
    std::string text;
    for (const auto& [name, value] : metadata) {
        text += "# " + plain_name(name, name.size()) + ": ";
        for (const char letter : value) {
            text += letter == '\r' ? ' ' : letter;
            if (letter == '\n')
                text += "# ";
        }
        text += '\n';
    }
    return text;
}

/// The words of a header, between white space and comments.
class HeaderWords {
public:
    HeaderWords(std::string_view text, const std::string& name)
        : text_(text)
        , name_(name) {}

    std::string_view take() {
        skip_space();
        const std::size_t start = position_;
        while (position_ < text_.size() && !is_space(text_[position_]))
            ++position_;
        return text_.substr(start, position_ - start);
    }

    std::size_t take_number(const char* what, std::size_t largest) {
        const std::string_view word = take();
        std::size_t number = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
        if (error != std::errc() || end != word.data() + word.size() || number == 0
            || number > largest)
            throw_damaged(
                name_,
                fmt::format(
                    "expected its {}, from 1 to {}, found '{}'",
                    what,
                    largest,
                    plain_name(std::string(word.substr(0, 40)), 40)));
        return number;
    }

    /// Where the samples begin: behind the one white space that ends the header.
    std::size_t end() const { return std::min(position_ + 1, text_.size()); }

private:
    static bool is_space(char letter) {
        return letter == ' ' || (letter >= '\t' && letter <= '\r');
    }

    void skip_space() {
        while (position_ < text_.size()
               && (is_space(text_[position_]) || text_[position_] == '#')) {
            if (text_[position_] == '#')
                position_ = std::min(text_.find('\n', position_), text_.size() - 1);
            ++position_;
        }
    }

    std::string_view text_;
    const std::string& name_;
    std::size_t position_ = 0;
};

constexpr std::size_t largest_side = (std::size_t{1} << 31) - 1;

/// The bytes of the samples, which must all be there.
std::span<const std::byte> sample_bytes(
    std::span<const std::byte> rest,
    std::size_t width,
    std::size_t height,
    std::size_t pixel_bytes,
    const std::string& name) {
    // Divided, since the product may not fit.
    if (rest.size() / pixel_bytes / width < height)
        throw_damaged(
            name,
            fmt::format(
                "it ends early: {} x {} pixels of {} bytes do not fit into the {} bytes behind its "
                "header",
                width,
                height,
                pixel_bytes,
                rest.size()));
    return rest.first(width * height * pixel_bytes);
}

std::string_view as_text(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A sample of a picture whose white is largest, stretched so that white is full.
template <typename Sample>
Sample stretched(unsigned value, unsigned largest, const std::string& name) {
    if (value > largest)
        throw_damaged(name, fmt::format("a sample is {}, more than its white, {}", value, largest));
    constexpr unsigned full = std::numeric_limits<Sample>::max();
    if (largest == full)
        return static_cast<Sample>(value);
    return static_cast<Sample>(
        (std::uint64_t{2} * value * full + largest) / (std::uint64_t{2} * largest));
}

} // namespace

void write_ppm(const Image& image, OutputFile& file, const PictureMetadata& metadata) {
    const bool wide = sample_type(image) == SampleType::integer16;
    file.write(fmt::format(
        "P6\n{}{} {}\n{}\n", comments(metadata), image.width, image.height, wide ? 65535 : 255));
    std::vector<std::byte> big_endian;
    for (std::size_t y = 0; y < image.height; ++y) {
        if (!wide) {
            file.write(std::as_bytes(row_of<std::uint8_t>(image, y)));
            continue;
        }
        big_endian.clear();
        for (const std::uint16_t sample : row_of<std::uint16_t>(image, y)) {
            big_endian.push_back(static_cast<std::byte>(sample >> 8));
            big_endian.push_back(static_cast<std::byte>(sample & 0xff));
        }
        file.write(big_endian);
    }
}

void write_pfm(const Image& image, OutputFile& file) {
    static_assert(std::endian::native == std::endian::little, "-1.0 says that bytes are swapped");
    file.write(fmt::format("PF\n{} {}\n-1.0\n", image.width, image.height));
    for (std::size_t y = image.height; y-- > 0;) // from the bottom up
        file.write(std::as_bytes(row_of<float>(image, y)));
}

Image read_ppm(std::span<const std::byte> bytes, const std::string& name) {
    HeaderWords words(as_text(bytes), name);
    words.take(); // P6
    const std::size_t width = words.take_number("width", largest_side);
    const std::size_t height = words.take_number("height", largest_side);
    const auto white = static_cast<unsigned>(words.take_number("largest sample", 65535));
    const bool wide = white > 255;
    const auto stored = sample_bytes(bytes.subspan(words.end()), width, height, wide ? 6 : 3, name);

    Image image = blank_image(width, height, wide ? SampleType::integer16 : SampleType::integer8);
    const auto byte = [&stored](std::size_t i) { return std::to_integer<unsigned>(stored[i]); };
    if (wide) {
        auto& samples = std::get<std::vector<std::uint16_t>>(image.samples);
        for (std::size_t i = 0; i < samples.size(); ++i)
            samples[i] = stretched<std::uint16_t>(byte(2 * i) << 8 | byte(2 * i + 1), white, name);
    } else {
        auto& samples = std::get<std::vector<std::uint8_t>>(image.samples);
        for (std::size_t i = 0; i < samples.size(); ++i)
            samples[i] = stretched<std::uint8_t>(byte(i), white, name);
    }
    return image;
}

Image read_pfm(std::span<const std::byte> bytes, const std::string& name) {
    HeaderWords words(as_text(bytes), name);
    words.take(); // PF
    const std::size_t width = words.take_number("width", largest_side);
    const std::size_t height = words.take_number("height", largest_side);
    // Only its sign counts: below 0, the least byte comes first.
    const std::string_view scale = words.take();
    double scale_value = 0;
    const auto [end, error] =
        std::from_chars(scale.data(), scale.data() + scale.size(), scale_value);
    if (error != std::errc() || end != scale.data() + scale.size() || scale_value == 0)
        throw_damaged(name, "expected its scale, a number such as -1.0");
    const auto stored = sample_bytes(bytes.subspan(words.end()), width, height, 12, name);

    Image image = blank_image(width, height, SampleType::float32);
    auto& samples = std::get<std::vector<float>>(image.samples);
    const std::size_t row_bytes = 12 * width;
    for (std::size_t y = 0; y < height; ++y)
        std::memcpy(
            samples.data() + 3 * width * (height - 1 - y),
            stored.data() + row_bytes * y,
            row_bytes);
    if (scale_value > 0)
        for (float& sample : samples)
            sample = std::bit_cast<float>(__builtin_bswap32(std::bit_cast<std::uint32_t>(sample)));
    return image;
}

} // namespace vera::detail
