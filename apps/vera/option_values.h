// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace vera {

// The value of an option, when it is within the bounds; else they throw CommandLineError.

std::uint32_t whole_of(const char* option, double value, std::uint32_t least, std::uint32_t most);
double number_of(const char* option, double value, double least, double most);

} // namespace vera
