// SPDX-License-Identifier: Apache-2.0
#include "vera/base/diagnostic.h"

#include <algorithm>

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

/// The part of a line that is shown, and the caret's place in it, counted from 0.
struct Excerpt {
    std::string text;
    std::size_t caret = 0;
    std::size_t caret_length = 1;
};

Excerpt excerpt(const Diagnostic& diagnostic) {
    constexpr std::size_t longest = 160;
    const std::string& line = diagnostic.line;
    const std::size_t column = std::min<std::size_t>(
        diagnostic.place.column == 0 ? 0 : diagnostic.place.column - 1, line.size());
    const std::size_t first =
        line.size() <= longest || column < longest / 2 ? 0 : column - longest / 2;

    Excerpt shown;
    for (std::size_t i = first; i < std::min(line.size(), first + longest); ++i) {
        const char letter = line[i];
        const bool control = static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f;
        // A tab would move the caret, and other control characters the terminal's cursor.
        shown.text += letter == '\t' ? ' ' : control ? '?' : letter;
    }
    shown.caret = column - first;
    const std::size_t room =
        std::max<std::size_t>(shown.text.size(), shown.caret + 1) - shown.caret;
    shown.caret_length = std::clamp<std::size_t>(diagnostic.length, 1, room);
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
