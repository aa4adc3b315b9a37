// SPDX-License-Identifier: Apache-2.0
#include "vera/image/palette.h"

#include "vera/base/diagnostic.h"

#include <charconv>

#include <fmt/format.h>

namespace vera {

namespace {

constexpr std::array<std::string_view, 5> names = {"bw", "rgb8", "ega16", "web216", "terminal256"};

Palette corners() {
    Palette palette;
    for (int i = 0; i < 8; ++i)
        palette.push_back(
            {static_cast<std::uint8_t>((i & 1) != 0 ? 255 : 0),
             static_cast<std::uint8_t>((i & 2) != 0 ? 255 : 0),
             static_cast<std::uint8_t>((i & 4) != 0 ? 255 : 0)});
    return palette;
}

/// The sixteen of the Enhanced Graphics Adapter, with its brown in place of a dark yellow.
Palette ega() {
    Palette palette;
    for (int i = 0; i < 16; ++i) {
        const int light = (i & 8) != 0 ? 85 : 0;
        const auto channel = [i, light](int bit) {
            return static_cast<std::uint8_t>(((i & bit) != 0 ? 170 : 0) + light);
        };
        palette.push_back({channel(4), channel(2), channel(1)});
    }
    palette[6] = {170, 85, 0};
    return palette;
}

void add_cube(Palette& palette, const std::array<std::uint8_t, 6>& steps) {
    for (const std::uint8_t r : steps)
        for (const std::uint8_t g : steps)
            for (const std::uint8_t b : steps)
                palette.push_back({r, g, b});
}

/// xterm's: sixteen, a cube of 6 x 6 x 6 from number 16 on, and 24 greys. The first sixteen may be
/// changed by who uses the terminal.
Palette terminal() {
    Palette palette = {
        {0, 0, 0},
        {205, 0, 0},
        {0, 205, 0},
        {205, 205, 0},
        {0, 0, 238},
        {205, 0, 205},
        {0, 205, 205},
        {229, 229, 229},
        {127, 127, 127},
        {255, 0, 0},
        {0, 255, 0},
        {255, 255, 0},
        {92, 92, 255},
        {255, 0, 255},
        {0, 255, 255},
        {255, 255, 255}};
    add_cube(palette, {0, 95, 135, 175, 215, 255});
    for (int i = 0; i < 24; ++i) {
        const auto grey = static_cast<std::uint8_t>(8 + 10 * i);
        palette.push_back({grey, grey, grey});
    }
    return palette;
}

std::string_view trimmed(std::string_view line) {
    line = line.substr(0, line.find(';'));
    while (!line.empty() && (line.back() == ' ' || line.back() == '\t' || line.back() == '\r'))
        line.remove_suffix(1);
    while (!line.empty() && (line.front() == ' ' || line.front() == '\t'))
        line.remove_prefix(1);
    return line;
}

std::optional<Rgb8> hexadecimal_color(std::string_view text) {
    std::uint32_t number = 0;
    if (text.size() != 7 || text.front() != '#')
        return std::nullopt;
    const auto [end, error] = std::from_chars(text.data() + 1, text.data() + 7, number, 16);
    if (error != std::errc() || end != text.data() + 7)
        return std::nullopt;
    return Rgb8{
        static_cast<std::uint8_t>(number >> 16),
        static_cast<std::uint8_t>(number >> 8 & 255),
        static_cast<std::uint8_t>(number & 255)};
}

} // namespace

std::optional<Palette> named_palette(std::string_view name) {
    if (name == "bw")
        return Palette{{0, 0, 0}, {255, 255, 255}};
    if (name == "rgb8")
        return corners();
    if (name == "ega16")
        return ega();
    if (name == "terminal256")
        return terminal();
    if (name == "web216") {
        Palette palette;
        add_cube(palette, {0, 51, 102, 153, 204, 255});
        return palette;
    }
    return std::nullopt;
}

std::string palette_names() {
    return fmt::format("{}", fmt::join(names, ", "));
}

Palette palette_from_text(std::string_view text, const std::string& name) {
    constexpr std::size_t most_colors = 256;
    constexpr std::size_t most_errors = 20;
    Palette palette;
    std::vector<Diagnostic> errors;
    for (std::uint64_t line = 1; !text.empty() && errors.size() < most_errors; ++line) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view word = trimmed(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (word.empty())
            continue;
        if (const auto color = hexadecimal_color(word))
            palette.push_back(*color);
        else
            errors.push_back(
                {.place = {name, line, 1},
                 .problem = fmt::format("expected a colour, found '{}'", word.substr(0, 40)),
                 .remedy = "write one of #rrggbb a line, as in #ff8000"});
    }
    if (errors.empty() && (palette.empty() || palette.size() > most_colors))
        errors.push_back(
            {.place = {name},
             .problem =
                 fmt::format("a palette has 1 to 256 colours, this one has {}", palette.size()),
             .remedy = "write one colour of #rrggbb a line"});
    if (!errors.empty())
        throw InputError(std::move(errors));
    return palette;
}

std::size_t nearest_color(std::span<const Oklab> colors, const Oklab& color) {
    std::size_t nearest = 0;
    double least = squared_distance(colors[0], color);
    for (std::size_t i = 1; i < colors.size(); ++i) {
        const double distance = squared_distance(colors[i], color);
        if (distance < least) {
            least = distance;
            nearest = i;
        }
    }
    return nearest;
}

} // namespace vera
