// SPDX-License-Identifier: Apache-2.0
#include "option_values.h"

#include "vera/base/similar_words.h"

#include <cmath>

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

std::string
similar_file(const std::filesystem::path& file, const std::vector<std::string>& known_extensions) {
    const auto similar = most_similar(file.extension().string(), known_extensions);
    if (!similar)
        return {};
    auto meant = file;
    return fmt::format("did you mean '{}'? Else ", meant.replace_extension(*similar).string());
}

} // namespace vera
