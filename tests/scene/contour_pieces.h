// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/primitives.h"

#include <cmath>

namespace vera::test {

inline ContourPiece line_to(ContourPiece::Point end) {
    ContourPiece piece;
    piece.end = end;
    return piece;
}

/// A quarter of a circle or an ellipse.
inline ContourPiece quarter_to(ContourPiece::Point end, ContourPiece::Point control) {
    ContourPiece piece;
    piece.kind = ContourPiece::Kind::conic;
    piece.control[0] = control;
    piece.weight = std::sqrt(0.5);
    piece.end = end;
    return piece;
}

inline ContourPiece
cubic_to(ContourPiece::Point end, ContourPiece::Point first, ContourPiece::Point second) {
    ContourPiece piece;
    piece.kind = ContourPiece::Kind::cubic;
    piece.control = {first, second};
    piece.end = end;
    return piece;
}

} // namespace vera::test
