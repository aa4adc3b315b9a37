// SPDX-License-Identifier: Apache-2.0
#include "line_options.h"

#include "vera/base/similar_words.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "command.h"
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace vera {

namespace {

constexpr char example[] = "silhouette:width=2,color=#333,dash=4-2";
constexpr double least_length = 0.01; // pixels
constexpr double most_length = 1000;

/// The text up to the separator, which is taken from it with that; or all of it.
std::string_view take_until(char separator, std::string_view& text) {
    const std::size_t end = std::min(text.find(separator), text.size());
    const std::string_view part = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return part;
}

[[noreturn]] void
complain_of_word(const char* what, std::string_view word, const std::vector<std::string>& known) {
    const auto similar = most_similar(word, known);
    throw CommandLineError(fmt::format(
        "--line knows no {} '{}'; {}it knows {}",
        what,
        word,
        similar ? fmt::format("did you mean '{}'? Else ", *similar) : "",
        fmt::join(known, ", ")));
}

std::optional<double> length_of(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !(value >= least_length)
        || value > most_length)
        return std::nullopt;
    return value;
}

double width_of(std::string_view text) {
    if (const auto width = length_of(text))
        return *width;
    throw CommandLineError(fmt::format(
        "--line takes a width from {} to {} pixels; found '{}'", least_length, most_length, text));
}

/// #rgb or #rrggbb.
DrawingColor color_of(std::string_view text) {
    const bool is_color = (text.size() == 4 || text.size() == 7) && text.front() == '#'
        && std::all_of(text.begin() + 1, text.end(), [](unsigned char letter) {
                              return std::isxdigit(letter) != 0;
                          });
    if (!is_color)
        throw CommandLineError(
            fmt::format("--line takes a color as #rgb or #rrggbb, such as #c00; found '{}'", text));
    const auto component = [&](std::size_t i) {
        const std::size_t digits = text.size() / 3; // 1 or 2
        unsigned value = 0;
        const char* const begin = text.data() + 1 + i * digits;
        std::from_chars(begin, begin + digits, value, 16);
        return static_cast<std::uint8_t>(digits == 1 ? 17 * value : value);
    };
    return {component(0), component(1), component(2)};
}

/// none, or lengths of dash, gap, dash ...
std::vector<double> dashes_of(std::string_view text) {
    std::vector<double> dashes;
    if (text == "none")
        return dashes;
    for (std::string_view rest = text; !rest.empty() || dashes.empty();) {
        const auto dash = length_of(take_until('-', rest));
        if (!dash || text.ends_with('-'))
            throw CommandLineError(fmt::format(
                "--line takes dashes and gaps from {} to {} pixels, as in dash=4-2, or dash=none; "
                "found '{}'",
                least_length,
                most_length,
                text));
        dashes.push_back(*dash);
    }
    return dashes;
}

LineStyle& style_of(std::string_view name, std::vector<LineStyle>& styles) {
    const auto line_class = line_class_from_name(name);
    if (!line_class)
        complain_of_word(
            "class of lines", name, {line_class_names.begin(), line_class_names.end()});
    for (LineStyle& style : styles)
        if (style.line_class == *line_class)
            return style;
    styles.push_back({.line_class = *line_class});
    return styles.back();
}

} // namespace

void apply_line_option(std::string_view text, std::vector<LineStyle>& styles) {
    const std::string_view whole = text;
    LineStyle& style = style_of(take_until(':', text), styles);
    if (text.empty())
        throw CommandLineError(fmt::format(
            "--line takes a class and what is to hold for it, as in {}; found '{}'",
            example,
            whole));
    while (!text.empty()) {
        std::string_view value = take_until(',', text);
        const std::string_view property = take_until('=', value);
        if (property == "width")
            style.width = width_of(value);
        else if (property == "color")
            style.color = color_of(value);
        else if (property == "dash")
            style.dashes = dashes_of(value);
        else
            complain_of_word("property of lines", property, {"width", "color", "dash"});
    }
}

} // namespace vera
