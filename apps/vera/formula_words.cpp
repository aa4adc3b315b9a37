// SPDX-License-Identifier: Apache-2.0
#include "formula_words.h"

#include <algorithm>

#include <CLI/CLI.hpp>

namespace vera {

namespace {

/// One minus, and not the letter of an option of the command.
bool is_negative_formula(const CLI::App& command, const std::string& word) {
    return word.size() > 1 && word[0] == '-' && word[1] != '-'
        && command.get_option_no_throw(word.substr(0, 2)) == nullptr;
}

} // namespace

std::vector<std::string> words_to_parse(const CLI::App& app, int argc, const char* const* argv) {
    std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
    if (words.size() > 2 && words[0] == "make" && words[1] == "surface") {
        const CLI::App& surface = *app.get_subcommand("make")->get_subcommand("surface");
        for (std::string& word : words)
            if (is_negative_formula(surface, word))
                word.insert(0, " ");
    }
    std::reverse(words.begin(), words.end());
    return words;
}

std::string typed_word(const std::string& word) {
    return word.starts_with(" -") ? word.substr(1) : word;
}

} // namespace vera
