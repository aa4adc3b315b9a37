// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/text_edits.h"

#include <algorithm>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace vera {

namespace {

constexpr std::size_t context = 3;

/// The lines of a text, each with its end.
std::vector<std::string_view> lines_of(std::string_view text) {
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
        lines.push_back(text.substr(0, end));
        text.remove_prefix(end);
    }
    return lines;
}

/// Lines that are replaced, numbered from 0, and by what.
struct Change {
    std::size_t first = 0;
    std::size_t last = 0; ///< behind
    std::string text = {};
};

/// The change without the lines at both ends that stay: those that are shown around it are counted.
Change trimmed(std::span<const std::string_view> lines, const Change& change) {
    const auto after = lines_of(change.text);
    std::size_t begin = 0;
    const std::size_t most = std::min(after.size(), change.last - change.first);
    while (begin < most && after[begin] == lines[change.first + begin])
        ++begin;
    std::size_t end = 0;
    while (begin + end < most && after[after.size() - 1 - end] == lines[change.last - 1 - end])
        ++end;
    std::string text;
    for (const std::string_view line : std::span(after).subspan(begin, after.size() - begin - end))
        text += line;
    return {change.first + begin, change.last - end, std::move(text)};
}

/// Adds the change behind the others, if it is one. Lines that follow one another go together, and
/// then those in their place.
void add_change(Change change, std::vector<Change>& changes) {
    if (change.first == change.last && change.text.empty())
        return;
    const bool follows = !changes.empty() && changes.back().last == change.first
        && (changes.back().text.empty() || changes.back().text.ends_with('\n'));
    if (!follows)
        return changes.push_back(std::move(change));
    changes.back().last = change.last;
    changes.back().text += change.text;
}

/// Of the edits; those that share a line are one change.
std::vector<Change> changes_of(
    std::string_view text,
    const std::vector<std::string_view>& lines,
    const std::vector<TextEdit>& edits) {
    std::vector<std::size_t> begins = {0};
    for (const std::string_view line : lines)
        begins.push_back(begins.back() + line.size());
    const auto line_at = [&](std::size_t offset) {
        const auto after = std::upper_bound(begins.begin() + 1, begins.end(), offset);
        return std::min(
            static_cast<std::size_t>(after - begins.begin()) - 1,
            lines.empty() ? 0 : lines.size() - 1);
    };
    std::vector<Change> changes;
    for (std::size_t i = 0; i < edits.size();) {
        const std::size_t first = line_at(edits[i].offset);
        std::size_t last = first + 1;
        const std::size_t first_edit = i;
        while (i < edits.size() && (i == first_edit || line_at(edits[i].offset) < last)) {
            const TextEdit& edit = edits[i++];
            const std::size_t end = edit.offset + edit.length;
            if (edit.length == 0)
                continue;
            // Where the end of a line goes, the next one joins it, but for lines that go as a
            // whole.
            const bool is_whole = begins[line_at(edit.offset)] == edit.offset
                && (edit.text.empty() || edit.text.ends_with('\n'));
            last = std::max(last, line_at(is_whole ? end - 1 : end) + 1);
        }
        last = std::min(last, lines.size());
        std::vector<TextEdit> within(
            edits.begin() + static_cast<std::ptrdiff_t>(first_edit),
            edits.begin() + static_cast<std::ptrdiff_t>(i));
        for (TextEdit& edit : within)
            edit.offset -= begins[first];
        const std::string_view before = text.substr(begins[first], begins[last] - begins[first]);
        add_change(trimmed(lines, {first, last, edited(before, within)}), changes);
    }
    return changes;
}

/// "4,7": so many lines from line 4 on; of one line its number alone, of none the line before.
std::string range_text(std::size_t first, std::size_t count) {
    const std::size_t number = count == 0 ? first : first + 1;
    return count == 1 ? fmt::format("{}", number) : fmt::format("{},{}", number, count);
}

void add_line(std::string& diff, char mark, std::string_view line) {
    diff += mark;
    diff += line;
    if (!line.ends_with('\n'))
        diff += "\n\\ No newline at end of file\n";
}

} // namespace

std::vector<TextEdit> in_order(std::vector<TextEdit> edits) {
    std::stable_sort(edits.begin(), edits.end(), [](const TextEdit& a, const TextEdit& b) {
        return a.offset < b.offset;
    });
    std::vector<TextEdit> kept;
    for (TextEdit& edit : edits)
        if (kept.empty() || edit.offset >= kept.back().offset + kept.back().length)
            kept.push_back(std::move(edit));
    return kept;
}

std::string edited(std::string_view text, const std::vector<TextEdit>& edits) {
    std::string result;
    std::size_t at = 0;
    for (const TextEdit& edit : edits) {
        result += text.substr(at, edit.offset - at);
        result += edit.text;
        at = edit.offset + edit.length;
    }
    result += text.substr(at);
    return result;
}

std::string unified_diff(
    std::string_view text,
    const std::vector<TextEdit>& edits,
    std::string_view name_before,
    std::string_view name_after) {
    const std::vector<std::string_view> lines = lines_of(text);
    const std::vector<Change> changes = changes_of(text, lines, edits);
    if (changes.empty())
        return {};
    std::string diff = fmt::format("--- {}\n+++ {}\n", name_before, name_after);
    std::size_t added = 0; // lines by the changes so far
    std::size_t removed = 0;
    for (std::size_t i = 0; i < changes.size();) {
        const std::size_t first = changes[i].first - std::min(context, changes[i].first);
        std::size_t at = first;
        std::size_t new_lines = 0;
        const std::size_t shift_added = added;
        const std::size_t shift_removed = removed;
        std::string body;
        const auto add_context = [&](std::size_t last) {
            for (; at < last; ++at, ++new_lines)
                add_line(body, ' ', lines[at]);
        };
        do {
            const Change& change = changes[i];
            add_context(change.first);
            for (; at < change.last; ++at)
                add_line(body, '-', lines[at]);
            const auto after = lines_of(change.text);
            for (const std::string_view line : after)
                add_line(body, '+', line);
            new_lines += after.size();
            added += after.size();
            removed += change.last - change.first;
            ++i;
        } while (i < changes.size() && changes[i].first <= at + 2 * context);
        add_context(std::min(at + context, lines.size()));
        diff += fmt::format(
            "@@ -{} +{} @@\n{}",
            range_text(first, at - first),
            range_text(first + shift_added - shift_removed, new_lines),
            body);
    }
    return diff;
}

} // namespace vera
