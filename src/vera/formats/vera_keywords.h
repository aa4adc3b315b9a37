// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace vera {

/// The words that begin a statement of the scene language.
enum class Statement : std::uint8_t {
    projection,
    parallel,
    light,
    sphere,
    triangle,
    quadrangle,
    polygon,
    patch,
    rotational_shape,
    subscene_call,
    material_change,
    inner_point,
    material,
    subscene,
    include,
    mesh,
    make
};

/// All words of the scene language. Reserved: no material and no subscene has such a name. Those
/// that begin statements come first.
constexpr std::array<std::string_view, 37> scene_words = {
    "PROJECTION", "PARALLEL", "LI",  "SP",  "P3",    "P4",      "PN",   "PA", "RS", "RK",
    "SSC",        "CM",       "IP",  "MA",  "SCENE", "INCLUDE", "MESH", "MK", "P",  "V",
    "AN",         "GE",       "KR",  "KE",  "KU",    "MX",      "RT",   "TR", "SC", "DRF",
    "ARF",        "SDI",      "SAN", "RAB", "TAB",   "SPC",     "REF"};

/// How many of them begin statements.
constexpr std::size_t statement_word_count = 18;

constexpr std::array<std::string_view, 4> contour_words = {"GE", "KR", "KE", "KU"};
constexpr std::array<std::string_view, 4> transformation_words = {"MX", "RT", "TR", "SC"};
constexpr std::array<std::string_view, 8> property_words = {
    "DRF", "ARF", "SDI", "SAN", "RAB", "TAB", "SPC", "REF"};

/// Two letters as a number, which is compared in one step.
constexpr unsigned letter_pair(std::string_view word) {
    return static_cast<unsigned char>(word[0]) * 256U + static_cast<unsigned char>(word[1]);
}

/// The statements of two letters, those of which texts have most first. RS and RK begin the same.
constexpr std::array<std::pair<unsigned, Statement>, 12> short_statements = {{
    {letter_pair("P3"), Statement::triangle},
    {letter_pair("SP"), Statement::sphere},
    {letter_pair("P4"), Statement::quadrangle},
    {letter_pair("PA"), Statement::patch},
    {letter_pair("CM"), Statement::material_change},
    {letter_pair("IP"), Statement::inner_point},
    {letter_pair("PN"), Statement::polygon},
    {letter_pair("RS"), Statement::rotational_shape},
    {letter_pair("RK"), Statement::rotational_shape},
    {letter_pair("MA"), Statement::material},
    {letter_pair("LI"), Statement::light},
    {letter_pair("MK"), Statement::make},
}};

constexpr std::array<std::pair<std::string_view, Statement>, 6> long_statements = {{
    {"SSC", Statement::subscene_call},
    {"MESH", Statement::mesh},
    {"SCENE", Statement::subscene},
    {"INCLUDE", Statement::include},
    {"PARALLEL", Statement::parallel},
    {"PROJECTION", Statement::projection},
}};

/// The statement that a word begins, or nothing.
inline std::optional<Statement> statement_named(std::string_view word) {
    if (word.size() == 2) {
        const unsigned pair = letter_pair(word);
        for (const auto& [name, statement] : short_statements)
            if (pair == name)
                return statement;
        return std::nullopt;
    }
    for (const auto& [name, statement] : long_statements)
        if (word == name)
            return statement;
    return std::nullopt;
}

} // namespace vera
