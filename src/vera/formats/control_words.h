// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace vera {

/// The keywords of control files.
constexpr std::array<std::string_view, 15> control_words = {
    "RASTER",
    "RTDEPTH",
    "EXPMES",
    "AMBIENT",
    "SKY",
    "HORIZON",
    "EARTH",
    "PROFILE",
    "SHADOWS",
    "ANTI-ALIAS",
    "FRAME",
    "ASPECT",
    "SAMPLES",
    "TOLERANCE",
    "LIGHTS"};

inline bool is_control_word(std::string_view word) {
    return std::find(control_words.begin(), control_words.end(), word) != control_words.end();
}

} // namespace vera
