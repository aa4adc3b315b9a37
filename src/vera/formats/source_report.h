// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/diagnostic.h"
#include "vera/formats/source_text.h"

#include <cstddef>
#include <string>
#include <vector>

namespace vera {

/// How often something worth one warning has happened, and where first.
struct Tally {
    std::size_t count = 0;
    std::size_t first = 0;

    void add(std::size_t offset) {
        if (count++ == 0)
            first = offset;
    }
};

/// Collects what is wrong with one mesh or NFF file. Reading ends after most_errors; warnings are
/// given once a kind, by way of a Tally, so that no input makes the lists long.
class SourceReport {
public:
    static constexpr std::size_t most_errors = 20;

    /// How places are named: by line and column, or, in a binary file, by the byte.
    enum class Places { lines, bytes };

    explicit SourceReport(const SourceText& source, Places places = Places::lines)
        : source_(source)
        , places_(places) {}

    void
    error(std::size_t offset, std::size_t length, std::string problem, std::string remedy = {});
    void
    warning(std::size_t offset, std::size_t length, std::string problem, std::string remedy = {});

    bool any_error() const { return errors_ > 0; }

    /// So many errors that reading on helps nobody.
    bool full() const { return errors_ >= most_errors; }

    const SourceText& source() const { return source_; }

    /// Adds the warnings to those of others. Throws InputError, with them, if there is any error.
    void finish(std::vector<Diagnostic>& warnings);

private:
    Diagnostic diagnostic(
        Severity severity,
        std::size_t offset,
        std::size_t length,
        std::string problem,
        std::string remedy) const;

    const SourceText& source_;
    Places places_;
    std::vector<Diagnostic> diagnostics_;
    std::size_t errors_ = 0;
};

/// "1 face", "3 faces".
std::string counted(std::size_t count, const char* singular, const char* plural);

} // namespace vera
