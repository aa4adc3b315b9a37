// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/render/statistics.h"

#include <cstddef>
#include <string>
#include <vector>

namespace vera {

/// A step of the ladder as the sheet shows it.
struct SheetStep {
    std::string title;           ///< "Diffuse light"
    std::string text;            ///< what is added: a sentence or two
    std::string picture;         ///< the bytes of a PNG file
    std::string difference;      ///< likewise; empty for the first step
    std::string difference_text; ///< "4 times the difference to 2"
    RenderStatistics counts;
    double seconds = 0;
};

struct Sheet {
    std::string title;     ///< the scene's name
    std::size_t width = 1; ///< of the pictures, in pixels
    std::size_t height = 1;
    std::vector<SheetStep> steps;
};

/// All steps on one page as an SVG that needs no other file: the pictures with captions, two in a
/// row, and what each cost in rays.
std::string sheet_svg(const Sheet& sheet);

/// The bytes in the letters of Base64 (RFC 4648, section 4).
std::string base64(const std::string& bytes);

} // namespace vera
