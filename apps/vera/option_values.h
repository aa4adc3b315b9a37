// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vera {

// The value of an option, when it is within the bounds; else they throw CommandLineError.

std::uint32_t whole_of(const char* option, double value, std::uint32_t least, std::uint32_t most);
double number_of(const char* option, double value, double least, double most);

/// A size of memory: "500M", "2.5G", K and T likewise, each 1024 times the one before, or bytes.
std::uint64_t bytes_of(const char* option, const std::string& size);

/// "did you mean 'a.png'? Else " for a name whose extension is like one of those that are known.
std::string
similar_file(const std::filesystem::path& file, const std::vector<std::string>& known_extensions);

} // namespace vera
