// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/complaints.h"
#include "vera/formats/source_text.h"
#include "vera/math/color.h"
#include "vera/math/vec3.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace vera {

/// Reads a VERA text word by word: words stand between white space and comments `(* ... *)`. What
/// it is asked to take and cannot, it complains of: once, and then returns nothing. The word that
/// was in the way has not been taken.
class WordReader {
public:
    /// The text and the complaints must outlive the reader.
    WordReader(const SourceText& text, Complaints& complaints);

    /// The next word, without taking it; empty at the end of the text.
    std::string_view peek();

    /// Takes the word that peek() gives.
    void take();

    /// Takes words until one for which stop is true, or the end.
    template <typename Stop>
    void take_until(const Stop& stop) {
        for (std::string_view word = peek(); !word.empty() && !stop(word); word = peek())
            take();
    }

    /// A finite number. What says what it is for: "the sphere's radius".
    std::optional<double> take_number(const char* what);

    /// Three numbers, the coordinates of what.
    std::optional<Vec3> take_point(const char* what);

    /// Three numbers, the red, green and blue of what.
    std::optional<Color> take_color(const char* what);

    /// A whole number from smallest to largest.
    std::optional<std::uint64_t>
    take_whole_number(const char* what, std::uint64_t smallest, std::uint64_t largest);

    /// A letter, then letters, digits, `_` and `-`; none of the reserved words.
    std::optional<std::string_view>
    take_name(const char* what, std::span<const std::string_view> reserved);

    /// What stands between double quotes on one line: sort says what, "formula", and remedy how.
    std::optional<std::string_view> take_quoted(std::string_view sort, std::string_view remedy);

    /// A file name between double quotes on one line.
    std::optional<std::string_view> take_file_name();

    /// The place of the next word.
    WordPlace place();

    /// Whether the next word is the first of its line.
    bool at_line_start();

    /// The place of the word taken last.
    const WordPlace& last_place() const { return last_; }

    /// Complains that the next word is not what was expected.
    void expected(std::string_view what, std::string remedy = {});

    /// The part of the text that has not been taken yet.
    std::string_view rest() const { return {at_, static_cast<std::size_t>(end_ - at_)}; }

    /// Lets the memory of what has been read go, now and then, when the text is a mapped file.
    void forget_what_was_read() { spent_.up_to(offset()); }

    std::size_t offset() const { return static_cast<std::size_t>(at_ - text_.text().data()); }

    std::uint64_t line() const { return line_; }

    const SourceText& text() const { return text_; }

    Complaints& complaints() const { return complaints_; }

private:
    void skip_space();
    void skip_comment();
    const char* word_end(const char* word) const;
    WordPlace place_of(const char* word, std::size_t length) const;
    void complain_of_number(const char* part, const char* what);
    bool take_number(double& value, const char* part, const char* what);

    const SourceText& text_;
    Complaints& complaints_;
    const char* at_;
    const char* end_;
    const char* line_begin_;
    std::uint64_t line_ = 1;
    WordPlace last_;
    SpentText spent_;
    bool in_open_comment_ = false;
};

/// A word as messages show it: between quotes, cut when long, control characters written out.
std::string shown(std::string_view word);

/// "; did you mean 'SP'?" when one of the words is like this one, else nothing.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

} // namespace vera
