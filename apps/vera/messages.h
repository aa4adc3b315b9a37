// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/diagnostic.h"

#include <span>
#include <string_view>

#include "command.h"

namespace vera {

/// Makes sure that no file is opened under the number of a standard stream that the program was
/// started without: messages would be written into it.
void occupy_standard_streams();

/// Writes to stderr, and does nothing where that cannot be written: nobody is told less than a
/// program that stops for it would tell.
void print_message(std::string_view text);

/// Prints diagnostics to stderr; of warnings and notes nothing when the console is quiet.
void print_diagnostics(std::span<const Diagnostic> diagnostics, const Console& console);

/// Prints "vera: error: message" to stderr.
void print_error(std::string_view message, const Console& console);

/// Prints a line to stderr unless the console is quiet.
void print_note(std::string_view message, const Console& console);

/// Prints what --json tells of an output: to stdout or, where that is the output ("-"), to stderr,
/// which may be closed: the output is good without.
void print_report(std::string_view json, std::string_view output);

/// Whether stderr gets colours: as asked for, else on a terminal unless NO_COLOR is set.
bool uses_color(const Console& console);

/// One diagnostic as a JSON object in the stated form (docs/json.md), as text.
std::string to_json(std::span<const Diagnostic> diagnostics);

} // namespace vera
