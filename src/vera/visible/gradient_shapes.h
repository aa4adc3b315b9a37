// SPDX-License-Identifier: Apache-2.0
// The shapes of gradients that suit samples: along which direction, or round which ellipses, their
// colours change.
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/visible/color_samples.h"

#include <optional>
#include <span>

namespace vera {

/// The unit eigenvector of the larger eigenvalue of a symmetric matrix.
DrawingPoint main_direction(double xx, double xy, double yy);

/// The direction along which the slopes of the samples lie, by least squares: exact where the
/// colour is a function of the way along it.
DrawingPoint direction_of_slopes(std::span<const ColorSample> samples, double tolerance);

/// The direction in which the planes through the colours, by least squares, change most: it sees
/// what changes between the samples as well.
DrawingPoint direction_of_planes(std::span<const ColorSample> samples, double tolerance);

/// The axis' direction, turned so that by least squares it fits the samples better: for a small
/// turn, what a gradient shows changes by its slope times the way across the axis.
DrawingPoint
turned(const Gradient& gradient, std::span<const ColorSample> samples, double tolerance);

/// Concentric ellipses, as the form of second degree whose levels they are: of a point p it has the
/// value (p - center) Q (p - center).
struct Ellipses {
    DrawingPoint center;
    double xx = 0;
    double xy = 0;
    double yy = 0;
};

/// The ellipses along which the samples change least: where it is steepest in the direction s, the
/// form's slope Q p - q is to have the same direction. That is a linear equation in Q and q, which
/// holds whatever colours the levels have.
std::optional<Ellipses> level_ellipses(std::span<const ColorSample> samples, double tolerance);

} // namespace vera
