// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace vera {

enum class DrawingStyle : std::uint8_t {
    flat,         ///< each face, and what is in shadow of it, in the light of its middle
    shaded,       ///< the same in gradients, as the light shades it
    ids,          ///< each primitive in the colour of its number, from 1 on; 0 is the background
    lines,        ///< what is seen of silhouettes, creases and intersections, alone
    hidden_lines, ///< and what is not seen of silhouettes and creases
    toon,         ///< flat in three tones of each colour, with the lines on top
};

/// When the outlines of faces are made: now, or while the drawing is written (see LaterFills),
/// which takes a third of the memory or less.
enum class FaceOutlines : std::uint8_t { now, later };

constexpr bool has_fills(DrawingStyle style) {
    return style != DrawingStyle::lines && style != DrawingStyle::hidden_lines;
}

constexpr bool has_lines(DrawingStyle style) {
    return !has_fills(style) || style == DrawingStyle::toon;
}

} // namespace vera
