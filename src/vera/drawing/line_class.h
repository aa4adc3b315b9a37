// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace vera {

/// Why a line is drawn, in the order in which the classes are painted: the last is in front.
enum class LineClass : std::uint8_t {
    hidden,       ///< a silhouette or crease that lies behind something
    shadow,       ///< where a shadow ends
    intersection, ///< where two surfaces meet, and one of them at least goes on beyond
    crease,       ///< where two surfaces end at each other, at an angle
    silhouette,   ///< where a surface ends before what lies behind it, or before nothing
};

/// What the classes are called in files and on the command line, by their numbers.
inline constexpr std::array<std::string_view, 5> line_class_names = {
    "hidden", "shadow", "intersection", "crease", "silhouette"};

inline constexpr std::string_view name_of(LineClass line_class) {
    return line_class_names[static_cast<std::size_t>(line_class)];
}

inline constexpr std::optional<LineClass> line_class_from_name(std::string_view name) {
    for (std::size_t i = 0; i < line_class_names.size(); ++i)
        if (line_class_names[i] == name)
            return static_cast<LineClass>(i);
    return std::nullopt;
}

} // namespace vera
