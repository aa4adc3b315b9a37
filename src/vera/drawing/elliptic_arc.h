// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing.h"

namespace vera {

/// The direction's angle from the x axis towards the y axis, from -180 to 180 degrees, within
/// 1e-12; 0 for no direction.
double direction_degrees(DrawingPoint direction);

/// The point of the ellipse at an angle in degrees: see DrawingEllipse.
DrawingPoint point_at(const DrawingEllipse& ellipse, double degrees);

/// The way along which the ellipse passes that point, towards larger angles.
DrawingPoint tangent_at(const DrawingEllipse& ellipse, double degrees);

/// The angle at which the ellipse, neither of whose axes is 0, is nearest to the point.
double nearest_degrees(const DrawingEllipse& ellipse, DrawingPoint point);

double distance(DrawingPoint a, DrawingPoint b);

/// The way from one angle in degrees to another by less than half a turn.
double turned(double from, double to);

/// The two inner control points of the cubic Bezier curve that follows the arc from one angle to
/// another. At 90 degrees it is off the arc by 2.8e-4 of the longer axis, at half of that by a
/// 64th.
struct BezierControls {
    DrawingPoint first;
    DrawingPoint second;
};

BezierControls bezier_controls(const DrawingEllipse& ellipse, double begin, double end);

/// The control point of the quadratic Bezier curve that has the arc's tangents at its ends, which
/// are less than half a turn apart.
DrawingPoint quadratic_control(const DrawingArc& arc);

/// How far that curve is off the arc at most; infinite for half a turn and more.
double quadratic_error(const DrawingArc& arc);

/// In how many equal parts of at most 90 degrees the arc is to be cut so that Bezier curves are off
/// it by no more than the error, which is positive.
int bezier_parts(const DrawingArc& arc, double error);

} // namespace vera
