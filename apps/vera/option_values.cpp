// SPDX-License-Identifier: Apache-2.0
#include "option_values.h"

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

} // namespace vera
