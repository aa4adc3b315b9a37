// SPDX-License-Identifier: Apache-2.0
#include "vera/base/diagnostic.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace vera {

namespace {

const char* name(Severity severity) {
    switch (severity) {
    case Severity::error:
        return "error";
    case Severity::warning:
        return "warning";
    case Severity::note:
        break;
    }
    return "note";
}

std::string place_text(const SourcePlace& place) {
    if (place.line == 0)
        return place.file;
    return fmt::format("{}:{}:{}", place.file, place.line, place.column);
}

/// The part of a line that is shown, and the caret's place in it, in characters counted from 0.
struct Excerpt {
    std::string text;
    std::size_t caret = 0;
    std::size_t caret_length = 1;
};

/// Whether a byte goes on with a character of UTF-8 that began before it.
bool continues_character(char byte) {
    return (static_cast<unsigned char>(byte) & 0xc0U) == 0x80;
}

/// How many characters of UTF-8 begin in a text.
std::size_t character_count(std::string_view text) {
    return text.size()
        - static_cast<std::size_t>(std::count_if(text.begin(), text.end(), continues_character));
}

/// The last beginning of a character at or before a place, or the end of the line.
std::size_t character_start(std::string_view line, std::size_t place) {
    while (place > 0 && place < line.size() && continues_character(line[place]))
        --place;
    return place;
}

Excerpt excerpt(const Diagnostic& diagnostic) {
    constexpr std::size_t longest = 160;
    const std::string_view line = diagnostic.line;
    const std::size_t column = std::min<std::size_t>(
        diagnostic.place.column == 0 ? 0 : diagnostic.place.column - 1, line.size());
    const std::size_t first = line.size() <= longest || column < longest / 2
        ? 0
        : character_start(line, column - longest / 2);
    const std::size_t last = character_start(line, std::min(line.size(), first + longest));

    Excerpt shown;
    for (const char letter : line.substr(first, last - first)) {
        const bool control = static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f;
        // A tab would move the caret, and other control characters the terminal's cursor.
        shown.text += letter == '\t' ? ' ' : control ? '?' : letter;
    }
    const std::string_view marked = line.substr(column, last - column).substr(0, diagnostic.length);
    shown.caret = character_count(line.substr(first, column - first));
    shown.caret_length = std::max<std::size_t>(character_count(marked), 1);
    return shown;
}

} // namespace

std::string to_text(const Diagnostic& diagnostic) {
    std::string text = fmt::format(
        "{}: {}: {}\n",
        place_text(diagnostic.place),
        name(diagnostic.severity),
        diagnostic.problem);
    if (!diagnostic.line.empty()) {
        const Excerpt shown = excerpt(diagnostic);
        text += fmt::format("    {}\n    {:{}}^", shown.text, "", shown.caret);
        text.append(shown.caret_length - 1, '~');
        text += '\n';
    }
    if (!diagnostic.remedy.empty())
        text += fmt::format("  {}\n", diagnostic.remedy);
    return text;
}

namespace {

std::string first_error(const std::vector<Diagnostic>& diagnostics) {
    for (const Diagnostic& diagnostic : diagnostics)
        if (diagnostic.severity == Severity::error)
            return fmt::format("{}: {}", place_text(diagnostic.place), diagnostic.problem);
    return "wrong input";
}

} // namespace

InputError::InputError(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(first_error(diagnostics))
    , diagnostics_(std::move(diagnostics)) {}

} // namespace vera
