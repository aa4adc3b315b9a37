// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
} // namespace CLI

namespace vera {

/// The words of a command line behind the program's name, so that app.parse() takes them from the
/// end on: those of `vera make surface` that begin with a minus and are none of its options get a
/// space before it, and are formulas as any other.
std::vector<std::string> words_to_parse(const CLI::App& app, int argc, const char* const* argv);

/// Such a word as it was typed.
std::string typed_word(const std::string& word);

} // namespace vera
