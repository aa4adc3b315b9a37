// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/diagnostic.h"
#include "vera/formats/source_text.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace vera {

/// Where a word stands in a text. Taken while reading, so that nothing has to be counted again.
struct WordPlace {
    const SourceText* text = nullptr;
    std::size_t offset = 0;
    std::size_t line_offset = 0; ///< where its line begins
    std::uint64_t line = 0;
    std::size_t length = 1;
};

/// Where the word stands, as messages name it.
SourcePlace source_place(const WordPlace& place);

Diagnostic
diagnostic_at(Severity severity, const WordPlace& place, std::string problem, std::string remedy);

/// Collects what is wrong with an input, and what its author should know. Keeps the lists short
/// whatever the input: reading ends after most_errors, and of warnings of one kind only the first
/// few are kept and the rest counted.
class Complaints {
public:
    static constexpr std::size_t most_errors = 50;
    static constexpr std::size_t most_warnings_of_a_kind = 10;

    void error(const WordPlace& place, std::string problem, std::string remedy = {});
    /// Takes over the errors and warnings of another reader.
    void add(const std::vector<Diagnostic>& diagnostics);

    /// The kind says in the plural what there may be many of: "faces without area".
    void warn(
        std::string_view kind,
        const WordPlace& place,
        std::string problem,
        std::string remedy = {});
    /// For warnings that are costly to make: make is called only when the warning is kept.
    void warn(std::string_view kind, const std::function<Diagnostic()>& make);

    std::size_t error_count() const { return errors_; }

    /// So many errors that reading on helps nobody.
    bool full() const { return errors_ >= most_errors; }

    /// The warnings, in the order of the text. Throws InputError, with all of it, if there is any
    /// error.
    std::vector<Diagnostic> finish();

private:
    std::vector<Diagnostic> diagnostics_;
    std::size_t errors_ = 0;
    std::map<std::string, std::size_t, std::less<>> warnings_;
};

} // namespace vera
