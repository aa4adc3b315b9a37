// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/complaints.h"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

namespace vera {

SourcePlace source_place(const WordPlace& place) {
    return {place.text->name(), place.line, place.offset - place.line_offset + 1};
}

Diagnostic
diagnostic_at(Severity severity, const WordPlace& place, std::string problem, std::string remedy) {
    return {
        .severity = severity,
        .place = source_place(place),
        .problem = std::move(problem),
        .remedy = std::move(remedy),
        .line = place.text->line_at(place.offset),
        .length = place.length};
}

void Complaints::error(const WordPlace& place, std::string problem, std::string remedy) {
    if (full())
        return;
    ++errors_;
    diagnostics_.push_back(
        diagnostic_at(Severity::error, place, std::move(problem), std::move(remedy)));
}

void Complaints::add(const std::vector<Diagnostic>& diagnostics) {
    for (const Diagnostic& diagnostic : diagnostics) {
        if (diagnostic.severity == Severity::error) {
            if (full())
                return;
            ++errors_;
        }
        diagnostics_.push_back(diagnostic);
    }
}

void Complaints::warn(
    std::string_view kind, const WordPlace& place, std::string problem, std::string remedy) {
    warn(kind, [&] {
        return diagnostic_at(Severity::warning, place, std::move(problem), std::move(remedy));
    });
}

void Complaints::warn(std::string_view kind, const std::function<Diagnostic()>& make) {
    auto counted = warnings_.find(kind);
    if (counted == warnings_.end())
        counted = warnings_.emplace(kind, 0).first;
    if (++counted->second <= most_warnings_of_a_kind)
        diagnostics_.push_back(make());
}

std::vector<Diagnostic> Complaints::finish() {
    // Checks at the end of a text speak of places before it; the files keep the order in which they
    // were first spoken of.
    std::map<std::string, std::size_t, std::less<>> files;
    for (const Diagnostic& diagnostic : diagnostics_)
        files.emplace(diagnostic.place.file, files.size());
    const auto key = [&](const Diagnostic& diagnostic) {
        return std::tuple(
            files.at(diagnostic.place.file), diagnostic.place.line, diagnostic.place.column);
    };
    std::stable_sort(
        diagnostics_.begin(), diagnostics_.end(), [&](const Diagnostic& a, const Diagnostic& b) {
            return key(a) < key(b);
        });

    const std::string file = diagnostics_.empty() ? std::string() : diagnostics_.front().place.file;
    for (const auto& [kind, count] : warnings_)
        if (count > most_warnings_of_a_kind)
            diagnostics_.push_back(
                {.severity = Severity::warning,
                 .place = {file, 0, 0},
                 .problem = fmt::format("{} more {}", count - most_warnings_of_a_kind, kind)});
    if (full())
        diagnostics_.push_back(
            {.severity = Severity::note,
             .place = {file, 0, 0},
             .problem = fmt::format("reading ended after {} errors", most_errors)});
    if (errors_ > 0)
        throw InputError(std::move(diagnostics_));
    return std::move(diagnostics_);
}

} // namespace vera
