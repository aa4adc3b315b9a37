// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace vera {

/// Where in an input something stands. Lines and columns count from 1, columns in bytes; line 0
/// means the file as a whole.
struct SourcePlace {
    std::string file;
    std::uint64_t line = 0;
    std::uint64_t column = 0;

    friend bool operator==(const SourcePlace&, const SourcePlace&) = default;
};

enum class Severity { error, warning, note };

/// One thing to tell the author of an input: where, what, and what to do about it.
struct Diagnostic {
    Severity severity = Severity::error;
    SourcePlace place = {};
    std::string problem = {}; ///< "expected the z of the sphere's center, found 'blue'"
    std::string remedy = {};  ///< what to do; may be empty when the problem says it already
    std::string line =
        {}; ///< the line of the input that place names, without its end; may be empty
    std::uint64_t length = 1; ///< how many bytes of the line, from the column on, the caret marks

    friend bool operator==(const Diagnostic&, const Diagnostic&) = default;
};

/// The diagnostic as a compiler prints it: place, severity, problem; the line; a caret; the remedy.
/// Ends in a newline. A line of more than 160 bytes is shown in part, round the column.
std::string to_text(const Diagnostic& diagnostic);

/// The input is wrong. Holds at least one error, and the warnings found on the way.
class InputError : public std::runtime_error {
public:
    explicit InputError(std::vector<Diagnostic> diagnostics);

    const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

private:
    std::vector<Diagnostic> diagnostics_;
};

} // namespace vera
