// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/document_text.h"

#include "vera/base/random.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace vera::detail {

namespace {

constexpr char32_t replacement = 0xfffd;

/// The character at the beginning of the text, which is not empty, and how many bytes it takes. A
/// byte that begins no character is a replacement character of its own: what is overlong, half of a
/// surrogate pair or beyond Unicode too.
struct Utf8Character {
    char32_t code = replacement;
    std::size_t bytes = 1;
};

Utf8Character first_character(std::string_view text) {
    const auto first = static_cast<unsigned char>(text.front());
    if (first < 0x80)
        return {first, 1};
    const int bytes = std::countl_one(first);
    if (bytes < 2 || bytes > 4 || text.size() < static_cast<std::size_t>(bytes))
        return {};
    char32_t code = first & (0x7fU >> bytes);
    for (int i = 1; i < bytes; ++i) {
        const auto next = static_cast<unsigned char>(text[static_cast<std::size_t>(i)]);
        if ((next & 0xc0U) != 0x80)
            return {};
        code = code << 6 | (next & 0x3fU);
    }
    constexpr char32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = code >= 0xd800 && code <= 0xdfff;
    if (code < least[bytes] || surrogate || code > 0x10ffff)
        return {};
    return {code, static_cast<std::size_t>(bytes)};
}

std::vector<char32_t> characters(std::string_view utf8) {
    std::vector<char32_t> codes;
    while (!utf8.empty()) {
        const Utf8Character character = first_character(utf8);
        codes.push_back(character.code);
        utf8.remove_prefix(character.bytes);
    }
    return codes;
}

bool is_letter(char letter) {
    return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z');
}

bool is_printable_ascii(char32_t code) {
    return code >= ' ' && code <= '~';
}

bool is_of_xml(char32_t code) {
    return code >= ' ' && code != 0xfffe && code != 0xffff;
}

} // namespace

std::string xml_text(std::string_view utf8) {
    std::string text;
    text.reserve(utf8.size());
    while (!utf8.empty()) {
        const Utf8Character character = first_character(utf8);
        const std::string_view bytes = utf8.substr(0, character.bytes);
        utf8.remove_prefix(character.bytes);
        switch (character.code) {
        case '&':
            text += "&amp;";
            break;
        case '<':
            text += "&lt;";
            break;
        case '>':
            text += "&gt;";
            break;
        case '"':
            text += "&quot;";
            break;
        // As they stand, those of an attribute would be read as blanks.
        case '\t':
            text += "&#9;";
            break;
        case '\n':
            text += "&#10;";
            break;
        default:
            // A replacement character is written anew: its bytes may be those of no character.
            text += is_of_xml(character.code) && character.code != replacement
                ? bytes
                : std::string_view("\xef\xbf\xbd");
        }
    }
    return text;
}

std::string pdf_string(std::string_view utf8) {
    const std::vector<char32_t> codes = characters(utf8);
    bool plain = true;
    for (const char32_t code : codes)
        plain = plain && is_printable_ascii(code);

    std::string text;
    if (plain) {
        for (const char32_t code : codes) {
            if (code == '(' || code == ')' || code == '\\')
                text += '\\';
            text += static_cast<char>(code);
        }
        return "(" + text + ")";
    }
    for (const char32_t code : codes) {
        const auto number = static_cast<std::uint32_t>(code);
        if (number < 0x10000)
            text += fmt::format("{:04X}", number);
        else
            text += fmt::format(
                "{:04X}{:04X}",
                0xd800 + ((number - 0x10000) >> 10),
                0xdc00 + ((number - 0x10000) & 0x3ff));
    }
    return "<FEFF" + text + ">";
}

std::string plain_line(std::string_view utf8) {
    constexpr std::size_t longest = 200;
    std::string line;
    for (const char32_t code : characters(utf8))
        if (line.size() < longest)
            line += is_printable_ascii(code) ? static_cast<char>(code) : '?';
    return line;
}

std::uint64_t hash_of(std::string_view bytes) {
    std::uint64_t hash = bytes.size();
    for (std::size_t i = 0; i < bytes.size(); i += sizeof hash) {
        std::uint64_t word = 0;
        for (const char byte : bytes.substr(i, sizeof hash))
            word = word << 8U | static_cast<unsigned char>(byte);
        hash = scrambled_bits(hash ^ word);
    }
    return hash;
}

std::string UniqueIds::take(std::string_view wanted) {
    std::string id;
    for (const char letter : wanted) {
        const bool digit = letter >= '0' && letter <= '9';
        const bool kept = is_letter(letter) || digit || letter == '_' || letter == '.';
        id += kept ? letter : '-';
    }
    if (id.empty() || !is_letter(id.front()))
        id.insert(0, 1, '_');

    // From the number on that was given last.
    std::uint32_t number = last_number_of(id);
    std::string unique = id;
    while (number > 0 && last_number_of(unique) > 0)
        unique = id + "-" + std::to_string(++number);
    set_last_number(unique, std::max<std::uint32_t>(last_number_of(unique), 1));
    set_last_number(id, std::max<std::uint32_t>(number, 1));
    return unique;
}

std::uint32_t UniqueIds::last_number_of(std::string_view id) const {
    return last_numbers_[place_of(hash_of(id))];
}

void UniqueIds::set_last_number(std::string_view id, std::uint32_t number) {
    const std::uint64_t hash = hash_of(id);
    const std::size_t place = place_of(hash);
    const bool is_new = last_numbers_[place] == 0;
    hashes_[place] = hash;
    last_numbers_[place] = number;
    const std::size_t size = hashes_.size();
    if (!is_new || ++count_ <= size - size / 4)
        return;
    const auto hashes = std::exchange(hashes_, std::vector<std::uint64_t>(2 * size));
    const auto numbers = std::exchange(last_numbers_, std::vector<std::uint32_t>(2 * size));
    for (std::size_t i = 0; i < size; ++i)
        if (numbers[i] > 0) {
            const std::size_t to = place_of(hashes[i]);
            hashes_[to] = hashes[i];
            last_numbers_[to] = numbers[i];
        }
}

/// Where the id of that hash stands, or would.
std::size_t UniqueIds::place_of(std::uint64_t hash) const {
    const std::size_t last = hashes_.size() - 1; // a power of two less one
    std::size_t place = hash & last;
    while (last_numbers_[place] > 0 && hashes_[place] != hash)
        place = (place + 1) & last;
    return place;
}

} // namespace vera::detail
