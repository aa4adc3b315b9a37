// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/number.h"
#include "vera/formats/source_report.h"
#include "vera/formats/source_text.h"
#include "vera/math/vec3.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace vera {

/// Goes through the text of a mesh or NFF file, word by word and line by line. Words stand between
/// blanks; a carriage return is a blank. A mark of the encoding at the beginning is passed over.
class TextCursor {
public:
    /// What ends a search for the next word.
    enum class Lines {
        end_at_newline,
        continue_behind_backslash, ///< as in OBJ: both together are a blank
        newlines_are_blanks,
        newlines_and_comments_are_blanks ///< comments go from # to the end of the line
    };

    TextCursor(SourceReport& report, Lines lines, std::size_t offset = 0)
        : report_(&report)
        , lines_(lines)
        , begin_(report.source().text().data())
        , at_(begin_ + offset)
        , end_(begin_ + report.source().text().size()) {
        if (offset > 0)
            return;
        refuse_utf16(report.source());
        at_ += encoding_mark_length(report.source().text());
    }

    bool at_end() const { return at_ == end_; }

    std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }

    /// Goes to the next word, at most to the end of the line where lines end.
    void skip_blanks() {
        while (at_ != end_ && (*at_ == ' ' || *at_ == '\t' || *at_ == '\r'))
            ++at_;
        if (at_ != end_ && (*at_ == '\n' || *at_ == '\\' || *at_ == '#'))
            skip_more();
    }

    /// Goes to the next word of the line, or the line's end, in whatever way lines end else.
    void skip_blanks_of_line() {
        while (at_ != end_ && (*at_ == ' ' || *at_ == '\t' || *at_ == '\r'))
            ++at_;
    }

    /// Whether nothing of the line is left but blanks, which are skipped.
    bool at_line_end() {
        if (newlines_are_blanks())
            skip_blanks_of_line();
        else
            skip_blanks();
        return at_ == end_ || *at_ == '\n'
            || (*at_ == '#' && lines_ == Lines::newlines_and_comments_are_blanks);
    }

    /// Goes behind the end of this line, and of those that continue it.
    void skip_line() {
        if (at_ != end_ && *at_ == '\n') {
            ++at_;
            return;
        }
        while (at_ != end_) {
            const void* const found = std::memchr(at_, '\n', static_cast<std::size_t>(end_ - at_));
            if (found == nullptr) {
                at_ = end_;
                return;
            }
            const char* const newline = static_cast<const char*>(found);
            const bool continued = lines_ == Lines::continue_behind_backslash && newline != at_
                && (newline[-1] == '\\'
                    || (newline[-1] == '\r' && newline - at_ > 1 && newline[-2] == '\\'));
            at_ = newline + 1;
            if (!continued)
                return;
        }
    }

    /// What is left of the line, without its end, wherever it goes on.
    std::string_view rest_of_line() const {
        const auto left = static_cast<std::size_t>(end_ - at_);
        const void* const newline = std::memchr(at_, '\n', left);
        return {
            at_,
            newline == nullptr ? left
                               : static_cast<std::size_t>(static_cast<const char*>(newline) - at_)};
    }

    /// Likewise, and without blanks before and after it: a name that may have blanks within.
    std::string_view name_of_line() const {
        std::string_view name = rest_of_line();
        while (!name.empty() && is_blank(name.back()))
            name.remove_suffix(1);
        while (!name.empty() && is_blank(name.front()))
            name.remove_prefix(1);
        return name;
    }

    /// Goes behind the end of this line, whatever it ends in.
    void skip_comment() {
        const void* const found = std::memchr(at_, '\n', static_cast<std::size_t>(end_ - at_));
        at_ = found == nullptr ? end_ : static_cast<const char*>(found) + 1;
    }

    /// The word at the cursor; empty at the end of a line or of the text.
    std::string_view word() const {
        const char* p = at_;
        while (p != end_ && !is_blank(*p))
            ++p;
        return {at_, static_cast<std::size_t>(p - at_)};
    }

    /// The word that word() gave is behind the cursor.
    void pass(std::string_view word) { at_ += word.size(); }

    /// The character at the cursor; NUL at the end of the text.
    char peek() const { return at_ == end_ ? '\0' : *at_; }

    void step() { ++at_; }

    /// Takes a finite number, and complains where there is none: `axis`, where it is not empty, and
    /// `what` say what it is for, "the x of" "the vertex".
    bool take_number(double& value, std::string_view axis, std::string_view what) {
        skip_blanks();
        const ScannedNumber number = scan_number(at_, end_);
        if (number.outcome == ScannedNumber::Outcome::good
            && (number.end == end_ || is_blank(*number.end))) {
            value = number.value;
            at_ = number.end;
            return true;
        }
        complain_of_number(axis, what);
        return false;
    }

    /// Takes what digits there are, and returns their number; of very many, one that is too large.
    std::uint64_t taken_digits() {
        constexpr std::uint64_t large_enough = 1'000'000'000'000;
        std::uint64_t number = 0;
        const char* p = at_;
        for (; p != end_ && *p >= '0' && *p <= '9'; ++p)
            if (number < large_enough)
                number = 10 * number + static_cast<std::uint64_t>(*p - '0');
        at_ = p;
        return number;
    }

    bool take_point(Vec3& point, std::string_view what) {
        return take_number(point.x, "the x of ", what) && take_number(point.y, "the y of ", what)
            && take_number(point.z, "the z of ", what);
    }

    /// Complains that the word at the cursor is not what was expected.
    void expected(std::string_view what, std::string remedy = {});

    /// A word as messages show it: quoted, cut when long, without control characters; at the end of
    /// a line or of the text, that.
    std::string shown_word() const;

private:
    static bool is_blank(char letter) {
        return letter == ' ' || letter == '\n' || letter == '\t' || letter == '\r';
    }

    bool newlines_are_blanks() const {
        return lines_ == Lines::newlines_are_blanks
            || lines_ == Lines::newlines_and_comments_are_blanks;
    }

    void skip_more();
    void complain_of_number(std::string_view axis, std::string_view what);

    SourceReport* report_;
    Lines lines_;
    const char* begin_;
    const char* at_;
    const char* end_;
};

} // namespace vera
