// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/word_reader.h"
#include "vera/scene/primitives.h"

#include <optional>
#include <vector>

namespace vera {

/// A chain of pieces, each with an area.
struct Contour {
    ContourPiece::Point start = {};
    std::vector<ContourPiece> pieces = {};
};

/// AN r h {GE r h | KR rm hm r h | KE rc hc w r h | KU r1 h1 r2 h2 r h}
/// KR is the circular arc through (rm, hm), in pieces of at most 120 degrees. Pieces without area,
/// which are those of no length and lines along the axis, are left out with a warning; where that
/// breaks the contour, it goes on as another.
std::optional<std::vector<Contour>> read_contour(WordReader& words);

} // namespace vera
