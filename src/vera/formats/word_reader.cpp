// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/word_reader.h"

#include "vera/base/similar_words.h"
#include "vera/base/utf8.h"
#include "vera/formats/number.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace vera {

namespace {

bool is_space(char letter) {
    return letter == ' ' || letter == '\n' || letter == '\t' || letter == '\r';
}

bool is_letter(char letter) {
    return (letter >= 'A' && letter <= 'Z') || (letter >= 'a' && letter <= 'z');
}

bool is_digit(char letter) {
    return letter >= '0' && letter <= '9';
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
    for (std::size_t at = text.find(from); at != std::string::npos;
         at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
}

bool is_number(std::string_view word) {
    const ScannedNumber number = scan_number(word.data(), word.data() + word.size());
    return number.outcome == ScannedNumber::Outcome::good
        && number.end == word.data() + word.size();
}

/// The number that a word was probably meant to be: with a letter for a digit, a decimal comma, a
/// typographic minus, or something behind it.
std::optional<std::string> likely_number(std::string_view word) {
    constexpr std::size_t longest = 40;
    if (word.size() > longest)
        return std::nullopt;
    std::string number(word);
    replace_all(number, "\xe2\x88\x92", "-");
    replace_all(number, "\xe2\x80\x93", "-");
    for (const auto& [from, to] : {std::pair{"O", "0"}, {"o", "0"}, {"l", "1"}, {"I", "1"}})
        replace_all(number, from, to);
    while (!number.empty() && std::string_view(",;f").find(number.back()) != std::string::npos)
        number.pop_back();
    if (std::count(number.begin(), number.end(), ',') == 1)
        replace_all(number, ",", ".");
    if (!is_number(number))
        return std::nullopt;
    return number;
}

} // namespace

std::string shown(std::string_view word) {
    constexpr std::size_t longest = 40;
    std::string result = "'";
    for (std::size_t i = 0; i < word.size();) {
        const std::size_t length = character_length(word.substr(i));
        if (i + std::max<std::size_t>(length, 1) > longest) {
            result += "...";
            break;
        }
        const auto byte = static_cast<unsigned char>(word[i]);
        if (length == 0 || byte < 0x20 || byte == 0x7f)
            result += fmt::format("\\x{:02x}", byte);
        else
            result += word.substr(i, length);
        i += std::max<std::size_t>(length, 1);
    }
    return result + "'";
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates) {
    const std::vector<std::string> words(candidates.begin(), candidates.end());
    const auto similar = most_similar(word, words);
    return similar ? fmt::format("; did you mean {}?", shown(*similar)) : std::string();
}

WordReader::WordReader(const SourceText& text, Complaints& complaints)
    : text_(text)
    , complaints_(complaints)
    , at_(text.text().data())
    , end_(at_ + text.text().size())
    , line_begin_(at_)
    , spent_(text) {
    refuse_utf16(text);
    at_ += encoding_mark_length(text.text());
}

WordPlace WordReader::place_of(const char* word, std::size_t length) const {
    const char* const begin = text_.text().data();
    return {
        &text_,
        static_cast<std::size_t>(word - begin),
        static_cast<std::size_t>(line_begin_ - begin),
        line_,
        length};
}

void WordReader::skip_space() {
    while (at_ != end_) {
        if (*at_ == '\n') {
            ++line_;
            line_begin_ = ++at_;
        } else if (is_space(*at_)) {
            ++at_;
        } else if (*at_ == '(' && end_ - at_ > 1 && at_[1] == '*') {
            skip_comment();
        } else {
            return;
        }
    }
}

void WordReader::skip_comment() {
    const WordPlace opening = place_of(at_, 2);
    at_ += 2;
    while (end_ - at_ > 1) {
        if (at_[0] == '*' && at_[1] == ')') {
            at_ += 2;
            return;
        }
        if (at_[0] == '(' && at_[1] == '*') {
            complaints_.warn(
                "comments within comments",
                place_of(at_, 2),
                fmt::format("'(*' inside the comment that begins in line {}", opening.line),
                "comments do not nest: both end at the next '*)'");
            ++at_;
            continue;
        }
        if (*at_ == '\n') {
            ++line_;
            line_begin_ = at_ + 1;
        }
        ++at_;
    }
    at_ = end_;
    in_open_comment_ = true;
    complaints_.error(opening, "this comment is never closed", "write '*)' where it ends");
}

const char* WordReader::word_end(const char* word) const {
    const char* end = word;
    while (end != end_ && !is_space(*end) && !(*end == '(' && end_ - end > 1 && end[1] == '*'))
        ++end;
    return end;
}

std::string_view WordReader::peek() {
    skip_space();
    return {at_, static_cast<std::size_t>(word_end(at_) - at_)};
}

void WordReader::take() {
    const std::string_view word = peek();
    last_ = place_of(at_, word.size());
    at_ += word.size();
}

WordPlace WordReader::place() {
    const std::string_view word = peek();
    return place_of(word.data(), std::max<std::size_t>(word.size(), 1));
}

bool WordReader::at_line_start() {
    peek();
    return std::all_of(line_begin_, at_, is_space);
}

void WordReader::expected(std::string_view what, std::string remedy) {
    const std::string_view word = peek();
    // What is missing stands in a comment without end, which has been complained of.
    if (word.empty() && in_open_comment_)
        return;
    const std::string found = word.empty() ? "the end of the file" : shown(word);
    complaints_.error(
        place(), fmt::format("expected {}, found {}", what, found), std::move(remedy));
}

// An optional number would be put together in memory: that takes longer than to read short ones.
bool WordReader::take_number(double& value, const char* part, const char* what) {
    if (at_ != end_ && *at_ == ' ')
        ++at_;
    if (at_ == end_ || *at_ <= ' ' || *at_ == '(')
        skip_space();
    const ScannedNumber scanned = scan_number(at_, end_);
    const bool whole_word =
        scanned.end == end_ || is_space(*scanned.end) || word_end(scanned.end) == scanned.end;
    if (scanned.outcome != ScannedNumber::Outcome::good || !whole_word) {
        complain_of_number(part, what);
        return false;
    }
    at_ = scanned.end;
    value = scanned.value;
    return true;
}

void WordReader::complain_of_number(const char* part, const char* what) {
    const std::string_view word = peek();
    const ScannedNumber scanned = scan_number(at_, end_);
    if (scanned.outcome == ScannedNumber::Outcome::too_large
        && scanned.end == word.data() + word.size()) {
        complaints_.error(
            place(),
            fmt::format("the number {} is too large", shown(word)),
            "the largest number is about 1.8e308");
        return;
    }
    if (const auto meant = likely_number(word)) {
        complaints_.error(
            place(),
            fmt::format("expected a number, found {}; did you mean {}?", shown(word), *meant),
            fmt::format("it is {}{}", part, what));
        return;
    }
    expected(fmt::format("{}{}", part, what));
}

std::optional<double> WordReader::take_number(const char* what) {
    double value = 0;
    if (!take_number(value, "", what))
        return std::nullopt;
    return value;
}

std::optional<Vec3> WordReader::take_point(const char* what) {
    Vec3 point;
    if (!take_number(point.x, "the x of ", what) || !take_number(point.y, "the y of ", what)
        || !take_number(point.z, "the z of ", what))
        return std::nullopt;
    return point;
}

std::optional<Color> WordReader::take_color(const char* what) {
    const WordPlace place = this->place();
    Color color;
    if (!take_number(color.r, "the red part of ", what)
        || !take_number(color.g, "the green part of ", what)
        || !take_number(color.b, "the blue part of ", what))
        return std::nullopt;
    if (color.r < 0 || color.g < 0 || color.b < 0)
        complaints_.warn(
            "colours below 0",
            place,
            fmt::format("{} is {} {} {}, in part below 0", what, color.r, color.g, color.b),
            "less than no light darkens what other light makes bright");
    return color;
}

std::optional<std::uint64_t>
WordReader::take_whole_number(const char* what, std::uint64_t smallest, std::uint64_t largest) {
    const WordPlace place = this->place();
    const std::string_view word = peek();
    const auto value = take_number(what);
    if (!value)
        return std::nullopt;
    if (!(*value >= static_cast<double>(smallest)) || !(*value <= static_cast<double>(largest))
        || *value != std::floor(*value)) {
        complaints_.error(
            place,
            fmt::format(
                "expected {}, a whole number from {} to {}, found {}",
                what,
                smallest,
                largest,
                shown(word)));
        return std::nullopt;
    }
    return static_cast<std::uint64_t>(*value);
}

std::optional<std::string_view>
WordReader::take_name(const char* what, std::span<const std::string_view> reserved) {
    const std::string_view word = peek();
    const bool is_name = !word.empty() && is_letter(word[0])
        && std::all_of(word.begin(), word.end(), [](char letter) {
               return is_letter(letter) || is_digit(letter) || letter == '_' || letter == '-';
           });
    if (!is_name) {
        expected(what, "names are a letter, then letters, digits, '_' and '-'");
        return std::nullopt;
    }
    if (std::find(reserved.begin(), reserved.end(), word) != reserved.end()) {
        expected(what, "that is a word of the language; names of small letters never are");
        return std::nullopt;
    }
    take();
    return word;
}

std::optional<std::string_view>
WordReader::take_quoted(std::string_view sort, std::string_view remedy) {
    const std::string_view word = peek();
    if (word.empty() || word[0] != '"') {
        expected(fmt::format("a {} in double quotes", sort), std::string(remedy));
        return std::nullopt;
    }
    const char* close = at_ + 1;
    while (close != end_ && *close != '"' && *close != '\n')
        ++close;
    if (close == end_ || *close == '\n') {
        complaints_.error(
            place(),
            fmt::format("this {} is never closed", sort),
            "write '\"' behind it, in the same line");
        return std::nullopt;
    }
    const std::string_view text = {at_ + 1, static_cast<std::size_t>(close - at_) - 1};
    last_ = place_of(at_, text.size() + 2);
    at_ = close + 1;
    return text;
}

std::optional<std::string_view> WordReader::take_file_name() {
    const WordPlace begin = place();
    const auto name = take_quoted("file name", "for example \"bunny.ply\"");
    if (name && (name->empty() || name->find('\0') != std::string_view::npos)) {
        complaints_.error(begin, "expected the name of a file, found none between the quotes");
        return std::nullopt;
    }
    return name;
}

} // namespace vera
