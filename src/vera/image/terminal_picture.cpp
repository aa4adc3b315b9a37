// SPDX-License-Identifier: Apache-2.0
#include "vera/image/terminal_picture.h"

#include "vera/base/check.h"
#include "vera/image/dither.h"
#include "vera/image/oklab.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include <fmt/format.h>

namespace vera {

namespace {

using Samples = std::vector<std::uint8_t>;

template <typename Sample>
LinearRgb light_of(const Sample* pixel) {
    if constexpr (std::is_same_v<Sample, float>) {
        LinearRgb light = {};
        for (std::size_t c = 0; c < 3; ++c)
            // What is not a number is dark, and what is brighter than white must not glow into
            // pixels beside it.
            light[c] = pixel[c] > 0 ? std::min(static_cast<double>(pixel[c]), 1.0) : 0;
        return light;
    } else {
        constexpr unsigned scale = std::numeric_limits<Sample>::max() / 255;
        Rgb8 color = {};
        for (std::size_t c = 0; c < 3; ++c)
            color[c] = static_cast<std::uint8_t>((pixel[c] + scale / 2) / scale);
        return linear_light(color);
    }
}

/// The mean light of the pixels that begin in one of `count` equal parts of each side.
template <typename Sample>
Rgb8 mean(
    const Image& image,
    const std::vector<Sample>& samples,
    std::size_t x,
    std::size_t y,
    PictureSize size) {
    LinearRgb sum = {};
    std::size_t count = 0;
    for (std::size_t row = y * image.height / size.height;
         row < (y + 1) * image.height / size.height;
         ++row)
        for (std::size_t column = x * image.width / size.width;
             column < (x + 1) * image.width / size.width;
             ++column) {
            const LinearRgb light = light_of(samples.data() + 3 * (row * image.width + column));
            for (std::size_t c = 0; c < 3; ++c)
                sum[c] += light[c];
            ++count;
        }
    for (double& value : sum)
        value /= static_cast<double>(count);
    return rgb8(sum);
}

std::string base64(const std::uint8_t* bytes, std::size_t size) {
    constexpr std::string_view letters =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < size; i += 3) {
        const std::size_t rest = std::min<std::size_t>(size - i, 3);
        unsigned group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < rest ? bytes[i + k] : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= rest ? letters[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

} // namespace

PictureSize fitted_size(const Image& image, std::size_t most_width, std::size_t most_height) {
    VERA_CHECK(image.width > 0 && image.height > 0 && most_width > 0 && most_height > 0);
    const auto width = static_cast<double>(image.width);
    const auto height = static_cast<double>(image.height);
    const double scale = std::min(
        {1.0, static_cast<double>(most_width) / width, static_cast<double>(most_height) / height});
    const auto scaled = [scale](double side) {
        return std::max<std::size_t>(static_cast<std::size_t>(std::lround(scale * side)), 1);
    };
    return {scaled(width), scaled(height)};
}

Image shrunk_image(const Image& image, std::size_t width, std::size_t height) {
    VERA_CHECK(width > 0 && height > 0);
    const PictureSize size = {std::min(width, image.width), std::min(height, image.height)};
    Image small = blank_image(size.width, size.height, SampleType::integer8);
    auto to = std::get<Samples>(small.samples).begin();
    std::visit(
        [&](const auto& samples) {
            for (std::size_t y = 0; y < size.height; ++y)
                for (std::size_t x = 0; x < size.width; ++x) {
                    const Rgb8 color = mean(image, samples, x, y, size);
                    to = std::copy(color.begin(), color.end(), to);
                }
        },
        image.samples);
    return small;
}

std::string half_blocks(const Image& image, TerminalColors colors) {
    const auto& samples = std::get<Samples>(image.samples);
    std::vector<std::uint8_t> numbers;
    if (colors == TerminalColors::indexed256) {
        // The first sixteen are as who uses the terminal likes them.
        constexpr std::ptrdiff_t changeable = 16;
        const Palette all = *named_palette("terminal256");
        // Pixels are so large here that an eye does not add them up.
        ColorReducer reducer({all.begin() + changeable, all.end()}, Dither::none, image.width);
        numbers.resize(image.width * image.height);
        for (std::size_t y = 0; y < image.height; ++y)
            reducer.reduce(
                std::span(samples).subspan(3 * image.width * y, 3 * image.width),
                std::span(numbers).subspan(image.width * y, image.width));
        for (std::uint8_t& number : numbers)
            number += changeable;
    }
    // 38 is the colour of letters, 48 that behind them.
    const auto color = [&](int where, std::size_t pixel) {
        if (colors == TerminalColors::indexed256)
            return fmt::format("\x1b[{};5;{}m", where, numbers[pixel]);
        return fmt::format(
            "\x1b[{};2;{};{};{}m",
            where,
            samples[3 * pixel],
            samples[3 * pixel + 1],
            samples[3 * pixel + 2]);
    };
    std::string text;
    for (std::size_t y = 0; y < image.height; y += 2) {
        std::string last_letter;
        std::string last_behind;
        for (std::size_t x = 0; x < image.width; ++x) {
            const std::string letter = color(38, y * image.width + x);
            // Below the last row of an odd number is what is behind the terminal.
            const std::string behind =
                y + 1 < image.height ? color(48, (y + 1) * image.width + x) : "\x1b[49m";
            text += letter == last_letter ? "" : letter;
            text += behind == last_behind ? "" : behind;
            text += "\u2580";
            last_letter = letter;
            last_behind = behind;
        }
        text += "\x1b[0m\n";
    }
    return text;
}

std::string kitty_graphics(const Image& image) {
    const auto& samples = std::get<Samples>(image.samples);
    const std::string data = base64(samples.data(), samples.size());
    constexpr std::size_t piece = 4096;
    // Transmit and show (a=T) samples of 24 bits (f=24), and answer nothing (q=2).
    std::string head = fmt::format("a=T,f=24,q=2,s={},v={},", image.width, image.height);
    std::string text;
    for (std::size_t at = 0; at < data.size(); at += piece) {
        const bool more = at + piece < data.size();
        text += fmt::format("\x1b_G{}m={};{}\x1b\\", head, more ? 1 : 0, data.substr(at, piece));
        head.clear();
    }
    return text + "\n";
}

} // namespace vera
