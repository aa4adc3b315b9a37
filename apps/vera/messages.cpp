// SPDX-License-Identifier: Apache-2.0
#include "messages.h"

#include <cstdio>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace vera {

namespace {

struct Paint {
    std::string_view word;
    std::string_view color;
};

constexpr std::string_view bold = "\x1b[1m";
constexpr std::string_view plain = "\x1b[0m";

Paint paint(Severity severity) {
    switch (severity) {
    case Severity::error:
        return {"error", "\x1b[1;31m"};
    case Severity::warning:
        return {"warning", "\x1b[1;35m"};
    case Severity::note:
        break;
    }
    return {"note", "\x1b[1;36m"};
}

/// The text of a diagnostic with its place, severity and caret line in colours.
std::string painted(const Diagnostic& diagnostic) {
    const auto [word, color] = paint(diagnostic.severity);
    std::string text = to_text(diagnostic);
    const std::string label = fmt::format(" {}: ", word);
    const std::size_t at = text.find(label);
    if (at != std::string::npos)
        text.replace(at, label.size(), fmt::format("{} {}{}:{} ", plain, color, word, plain));
    return fmt::format("{}{}", bold, text);
}

} // namespace

void occupy_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(stream, F_GETFD) == -1) {
            // The other way than it is used, so that to use it is an error as without it. The
            // lowest free number is taken, which is this one.
            [[maybe_unused]] const int taken =
                open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
        }
}

void print_message(std::string_view text) {
    // A stream that has failed once may be there again, as a disk that was full.
    std::clearerr(stderr);
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

bool uses_color(const Console& console) {
    if (console.color != Console::ColorStyle::automatic)
        return console.color == Console::ColorStyle::always;
    const char* const no_color = std::getenv("NO_COLOR");
    const char* const terminal = std::getenv("TERM");
    return isatty(STDERR_FILENO) == 1 && (no_color == nullptr || *no_color == '\0')
        && (terminal == nullptr || std::string_view(terminal) != "dumb");
}

void print_diagnostics(std::span<const Diagnostic> diagnostics, const Console& console) {
    const bool color = uses_color(console);
    for (const Diagnostic& diagnostic : diagnostics)
        if (!console.quiet || diagnostic.severity == Severity::error)
            print_message(color ? painted(diagnostic) : to_text(diagnostic));
}

void print_error(std::string_view message, const Console& console) {
    if (uses_color(console))
        print_message(fmt::format(
            "{}vera: {}error:{} {}\n", bold, paint(Severity::error).color, plain, message));
    else
        print_message(fmt::format("vera: error: {}\n", message));
}

void print_note(std::string_view message, const Console& console) {
    if (!console.quiet)
        print_message(fmt::format("{}\n", message));
}

void print_report(std::string_view json, std::string_view output) {
    if (output == "-")
        print_message(fmt::format("{}\n", json));
    else
        fmt::print("{}\n", json);
}

std::string to_json(std::span<const Diagnostic> diagnostics) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    std::size_t errors = 0;
    for (const Diagnostic& diagnostic : diagnostics) {
        errors += diagnostic.severity == Severity::error ? 1 : 0;
        list.push_back(
            {{"severity", paint(diagnostic.severity).word},
             {"file", diagnostic.place.file},
             {"line", diagnostic.place.line},
             {"column", diagnostic.place.column},
             {"length", diagnostic.length},
             {"problem", diagnostic.problem},
             {"remedy", diagnostic.remedy},
             {"text", diagnostic.line}});
    }
    const nlohmann::ordered_json report = {
        {"version", 1}, {"good", errors == 0}, {"errors", errors}, {"diagnostics", list}};
    // A line of binary junk is shown as far as it is text.
    return report.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

} // namespace vera
