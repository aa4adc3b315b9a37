// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

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
    mesh
};

/// All words of the scene language. Reserved: no material and no subscene has such a name. Those
/// that begin statements come first.
constexpr std::array<std::string_view, 36> scene_words = {
    "PROJECTION", "PARALLEL", "LI",  "SP",  "P3",  "P4",    "PN",      "PA",   "RS",
    "RK",         "SSC",      "CM",  "IP",  "MA",  "SCENE", "INCLUDE", "MESH", "P",
    "V",          "AN",       "GE",  "KR",  "KE",  "KU",    "MX",      "RT",   "TR",
    "SC",         "DRF",      "ARF", "SDI", "SAN", "RAB",   "TAB",     "SPC",  "REF"};

/// How many of them begin statements.
constexpr std::size_t statement_word_count = 17;

constexpr std::array<std::string_view, 4> contour_words = {"GE", "KR", "KE", "KU"};
constexpr std::array<std::string_view, 4> transformation_words = {"MX", "RT", "TR", "SC"};
constexpr std::array<std::string_view, 8> property_words = {
    "DRF", "ARF", "SDI", "SAN", "RAB", "TAB", "SPC", "REF"};

/// The statement that a word begins, or nothing. RS and RK begin the same.
inline std::optional<Statement> statement_named(std::string_view word) {
    switch (word.size()) {
    case 2:
        if (word == "P3")
            return Statement::triangle;
        if (word == "SP")
            return Statement::sphere;
        if (word == "P4")
            return Statement::quadrangle;
        if (word == "PA")
            return Statement::patch;
        if (word == "CM")
            return Statement::material_change;
        if (word == "IP")
            return Statement::inner_point;
        if (word == "PN")
            return Statement::polygon;
        if (word == "RS" || word == "RK")
            return Statement::rotational_shape;
        if (word == "MA")
            return Statement::material;
        if (word == "LI")
            return Statement::light;
        return std::nullopt;
    case 3:
        if (word == "SSC")
            return Statement::subscene_call;
        return std::nullopt;
    case 4:
        if (word == "MESH")
            return Statement::mesh;
        return std::nullopt;
    case 5:
        if (word == "SCENE")
            return Statement::subscene;
        return std::nullopt;
    case 7:
        if (word == "INCLUDE")
            return Statement::include;
        return std::nullopt;
    case 8:
        if (word == "PARALLEL")
            return Statement::parallel;
        return std::nullopt;
    case 10:
        if (word == "PROJECTION")
            return Statement::projection;
        return std::nullopt;
    default:
        return std::nullopt;
    }
}

} // namespace vera
