// SPDX-License-Identifier: Apache-2.0
#include "option_values.h"

#include "vera/base/similar_words.h"

#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>

#include "command.h"
#include <fmt/format.h>

namespace vera {

std::uint32_t whole_of(const char* option, double value, std::uint32_t least, std::uint32_t most) {
    if (!(value >= least && value <= most) || value != std::floor(value))
        throw CommandLineError(fmt::format(
            "{} takes a whole number from {} to {}; found {}", option, least, most, value));
    return static_cast<std::uint32_t>(value);
}

double number_of(const char* option, double value, double least, double most) {
    if (!(value >= least && value <= most))
        throw CommandLineError(
            fmt::format("{} takes a number from {} to {}; found {}", option, least, most, value));
    return value;
}

std::uint64_t bytes_of(const char* option, const std::string& size) {
    constexpr std::string_view units = "KMGT";
    std::string number = size;
    double unit = 1;
    const std::size_t found = size.empty()
        ? std::string_view::npos
        : units.find(static_cast<char>(std::toupper(static_cast<unsigned char>(size.back()))));
    if (found != std::string_view::npos) {
        unit = std::ldexp(1.0, 10 * static_cast<int>(found + 1));
        number.pop_back();
    }
    double value = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    const double bytes = unit * value;
    if (error != std::errc() || end != number.data() + number.size()
        || !(bytes >= 1 && bytes < 0x1p62))
        throw CommandLineError(
            fmt::format("{} takes a size as in 500M or 2.5G; found '{}'", option, size));
    return static_cast<std::uint64_t>(bytes);
}

std::string
similar_file(const std::filesystem::path& file, const std::vector<std::string>& known_extensions) {
    const auto similar = most_similar(file.extension().string(), known_extensions);
    if (!similar)
        return {};
    auto meant = file;
    return fmt::format("did you mean '{}'? Else ", meant.replace_extension(*similar).string());
}

} // namespace vera
