// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/statement_count.h"

#include "vera/formats/vera_keywords.h"

#include <array>
#include <cstdint>
#include <cstring>

namespace vera {

namespace {

/// True for the letters that keywords of geometry, and those that end scenes, begin with.
constexpr std::array<bool, 256> first_letters = [] {
    std::array<bool, 256> letters = {};
    for (const char letter : std::string_view("PSRMCIL"))
        letters[static_cast<unsigned char>(letter)] = true;
    return letters;
}();

bool is_word_letter(char letter) {
    return static_cast<unsigned char>(letter) > ' ';
}

/// A place from i on with no letter before it: letters have a bit that digits, signs and white
/// space lack, so that eight bytes are looked at together.
std::size_t skip_to_letter(std::string_view text, std::size_t i) {
    constexpr std::uint64_t letter_bits = 0x4040'4040'4040'4040;
    for (; i + 8 <= text.size(); i += 8) {
        std::uint64_t bytes = 0;
        std::memcpy(&bytes, text.data() + i, 8);
        if ((bytes & letter_bits) != 0)
            break;
    }
    return i;
}

std::size_t corner_count(std::string_view text) {
    constexpr std::size_t most = 100'000'000;
    std::size_t count = 0;
    std::size_t i = 0;
    while (i < text.size() && !is_word_letter(text[i]))
        ++i;
    for (; i < text.size() && text[i] >= '0' && text[i] <= '9' && count < most; ++i)
        count = 10 * count + static_cast<std::size_t>(text[i] - '0');
    // Never more than there is text for: six bytes a corner.
    return count < text.size() / 6 ? count : 0;
}

} // namespace

StatementCounts count_statements(std::string_view text, CountFor scene) {
    StatementCounts counts;
    for (std::size_t i = skip_to_letter(text, 0); i < text.size(); ++i) {
        if (!first_letters[static_cast<unsigned char>(text[i])]) {
            if (text[i] == ' ')
                i = skip_to_letter(text, i + 1) - 1;
            continue;
        }
        if (i > 0 && is_word_letter(text[i - 1]))
            continue;
        std::size_t end = i;
        while (end < text.size() && end < i + 11 && is_word_letter(text[end]))
            ++end;
        const auto statement = statement_named(text.substr(i, end - i));
        if (!statement)
            continue;
        switch (*statement) {
        case Statement::sphere:
            ++counts.spheres;
            break;
        case Statement::triangle:
            ++counts.triangles;
            break;
        case Statement::quadrangle:
            ++counts.polygons;
            counts.corners += 4;
            break;
        case Statement::polygon:
            ++counts.polygons;
            counts.corners += corner_count(text.substr(end));
            break;
        case Statement::patch:
            ++counts.patches;
            break;
        case Statement::rotational_shape:
        case Statement::subscene_call:
        case Statement::mesh:
        case Statement::make:
            ++counts.others;
            break;
        case Statement::subscene:
            return counts;
        case Statement::material:
        case Statement::light:
        case Statement::projection:
        case Statement::parallel:
            if (scene == CountFor::subscene)
                return counts;
            break;
        case Statement::material_change:
        case Statement::inner_point:
        case Statement::include:
            break;
        }
    }
    return counts;
}

} // namespace vera
