// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing.h"

namespace vera {

/// What a point of a drawing is to lie upon: an ellipse, or a straight line through a place in
/// pixels.
struct LineTrack {
    const DrawingEllipse* ellipse = nullptr; ///< nullptr: the line
    DrawingPoint place;
    DrawingPoint direction; ///< not of length 0
};

/// The track's nearest point.
DrawingPoint nearest_on(const LineTrack& track, DrawingPoint point);

/// Where the tracks cross near that point: on the first, and on the other too unless they do not
/// cross or all but touch.
DrawingPoint crossing_near(const LineTrack& one, const LineTrack& other, DrawingPoint point);

} // namespace vera
