// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/text_cursor.h"

#include <algorithm>
#include <cctype>
#include <string>

#include <fmt/format.h>

namespace vera {

void TextCursor::skip_more() {
    while (at_ != end_) {
        if (*at_ == ' ' || *at_ == '\t' || *at_ == '\r'
            || (*at_ == '\n' && newlines_are_blanks())) {
            ++at_;
        } else if (*at_ == '#' && lines_ == Lines::newlines_and_comments_are_blanks) {
            while (at_ != end_ && *at_ != '\n')
                ++at_;
        } else if (*at_ == '\\' && lines_ == Lines::continue_behind_backslash) {
            const char* p = at_ + 1;
            if (p != end_ && *p == '\r')
                ++p;
            if (p == end_ || *p != '\n')
                return;
            at_ = p + 1;
        } else {
            return;
        }
    }
}

std::string TextCursor::shown_word() const {
    if (at_ == end_)
        return "the end of the file";
    if (*at_ == '\n')
        return "the end of the line";
    constexpr std::size_t longest = 40;
    const std::string_view whole = word();
    std::string shown(whole.substr(0, longest));
    std::replace_if(
        shown.begin(), shown.end(), [](unsigned char c) { return c < 0x20 || c >= 0x7f; }, '?');
    return fmt::format("'{}{}'", shown, whole.size() > longest ? "..." : "");
}

void TextCursor::expected(std::string_view what, std::string remedy) {
    report_->error(
        offset(),
        std::max<std::size_t>(word().size(), 1),
        fmt::format("expected {}, found {}", what, shown_word()),
        std::move(remedy));
}

namespace {

/// "nan", "-inf", "Infinity" and the like.
bool is_written_non_finite(std::string_view word) {
    std::string letters(word.substr(0, 9));
    std::transform(letters.begin(), letters.end(), letters.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    std::string_view rest = letters;
    if (!rest.empty() && (rest.front() == '-' || rest.front() == '+'))
        rest.remove_prefix(1);
    return rest.substr(0, 3) == "nan" || rest.substr(0, 3) == "inf"
        || rest.substr(0, 3) == "1.#"; // as Microsoft's C library wrote both
}

} // namespace

void TextCursor::complain_of_number(std::string_view axis, std::string_view what) {
    const ScannedNumber number = scan_number(at_, end_);
    const std::size_t length = std::max<std::size_t>(word().size(), 1);
    if (number.outcome == ScannedNumber::Outcome::too_large)
        report_->error(
            offset(),
            length,
            fmt::format("{}{} is too large a number: {}", axis, what, shown_word()),
            "the largest number is 1.797e308");
    else if (is_written_non_finite(word()))
        report_->error(
            offset(),
            length,
            fmt::format("{}{} is not a finite number: {}", axis, what, shown_word()),
            "repair the program that wrote the file, or delete what uses this number");
    else
        expected(fmt::format("{}{}", axis, what));
}

} // namespace vera
