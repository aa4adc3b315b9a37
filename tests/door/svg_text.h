// SPDX-License-Identifier: Apache-2.0
// What tests of `vera draw` look for in what it writes.
#pragma once

#include <cstddef>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace vera {

/// How a scene begins.
inline const std::string view = "PROJECTION 0 2 8  -2 0 0  2 0 0  -2 4 0\n"
                                "LI 3 6 5  40 1 1 1\n"
                                "CM grey\n"
                                "MA grey DRF 0.7 0.7 0.7\n";

inline bool holds(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

/// The values of an attribute of the outlines, in their order, those of seams left out.
inline std::vector<std::string> of_outlines(const std::string& svg, const std::string& attribute) {
    std::vector<std::string> values;
    std::istringstream lines(svg);
    const std::string begin = " " + attribute + "=\"";
    for (std::string line; std::getline(lines, line);) {
        const std::size_t place = line.find(begin);
        if (!line.starts_with("<path") || holds(line, "class=\"seam\"")
            || place == std::string::npos)
            continue;
        const std::size_t value = place + begin.size();
        values.push_back(line.substr(value, line.find('"', value) - value));
    }
    return values;
}

inline std::size_t count_of(const std::string& text, std::string_view part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

} // namespace vera
