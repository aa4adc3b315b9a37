// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/source_report.h"

#include <utility>

#include <fmt/format.h>

namespace vera {

Diagnostic SourceReport::diagnostic(
    Severity severity,
    std::size_t offset,
    std::size_t length,
    std::string problem,
    std::string remedy) const {
    if (places_ == Places::lines)
        return source_.diagnostic(severity, offset, length, std::move(problem), std::move(remedy));
    return {
        .severity = severity,
        .place = {source_.name(), 0, 0},
        .problem = fmt::format("byte {}: {}", offset, problem),
        .remedy = std::move(remedy)};
}

void SourceReport::error(
    std::size_t offset, std::size_t length, std::string problem, std::string remedy) {
    if (full())
        return;
    ++errors_;
    diagnostics_.push_back(
        diagnostic(Severity::error, offset, length, std::move(problem), std::move(remedy)));
}

void SourceReport::warning(
    std::size_t offset, std::size_t length, std::string problem, std::string remedy) {
    diagnostics_.push_back(
        diagnostic(Severity::warning, offset, length, std::move(problem), std::move(remedy)));
}

void SourceReport::finish(std::vector<Diagnostic>& warnings) {
    if (full())
        diagnostics_.push_back(
            {.severity = Severity::note,
             .place = {source_.name(), 0, 0},
             .problem = fmt::format("reading ended after {} errors", most_errors)});
    if (any_error())
        throw InputError(std::move(diagnostics_));
    warnings.insert(warnings.end(), diagnostics_.begin(), diagnostics_.end());
    diagnostics_.clear();
}

std::string counted(std::size_t count, const char* singular, const char* plural) {
    return fmt::format("{} {}", count, count == 1 ? singular : plural);
}

} // namespace vera
