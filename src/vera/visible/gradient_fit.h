// SPDX-License-Identifier: Apache-2.0
// Colours and gradients that come near to samples of a field.
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/math/color.h"
#include "vera/visible/color_samples.h"

#include <optional>
#include <span>

namespace vera {

/// A colour or gradient, and by how much it differs at most from the samples that it was made for,
/// in any of red, green and blue, beyond their slack; 1 for 255.
struct FittedPaint {
    DrawingColor color;
    std::optional<Gradient> gradient; ///< in place of the colour
    double error = 0;
};

/// What the paint shows at the point.
Color color_at(const FittedPaint& paint, DrawingPoint point);

/// How far off the paint is where the sample is, beyond the sample's slack.
double error_of(const FittedPaint& paint, const ColorSample& sample);

// All take one sample or more. A fit ends as soon as its error is within the tolerance, and returns
// the best that was found where that cannot be. Stops are bytes, and the error is that with them.

/// The one colour that is nearest to all samples.
FittedPaint flat_fit(std::span<const ColorSample> samples);

/// A linear gradient along a direction in which the samples change most; its stops are set where
/// the samples ask for them.
FittedPaint linear_fit(std::span<const ColorSample> samples, double tolerance);

/// A radial gradient about the centre of the ellipses along which the samples change least; nothing
/// where there are no such ellipses.
std::optional<FittedPaint> radial_fit(std::span<const ColorSample> samples, double tolerance);

/// The first of these that is within the tolerance, or else the best.
FittedPaint best_fit(std::span<const ColorSample> samples, double tolerance);

} // namespace vera
