// SPDX-License-Identifier: Apache-2.0
// What a field of colours is like at single points, and the sums over such samples that fits of
// gradients are made of.
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/math/color.h"

#include <functional>
#include <span>
#include <vector>

namespace vera {

/// The colour, 1 for 255, at a point of the picture.
using ColorField = std::function<Color(DrawingPoint)>;

/// What a field is like at a point.
struct ColorSample {
    DrawingPoint point;
    Color color;
    double slack = 0;   ///< by how much more than elsewhere a paint may differ here, 1 for 255
    Color slope_x = {}; ///< how the color changes by pixels to the right, about
    Color slope_y = {}; ///< and downward
};

/// The sample at the point. Its slack is how much the field changes within that many pixels.
ColorSample color_sample(DrawingPoint point, const ColorField& field, double within);

/// A point, and the colour there.
struct PointColor {
    DrawingPoint point;
    Color color;
};

/// The same where the colour at the point is known.
ColorSample color_sample(const PointColor& at, const ColorField& field, double within);

/// The samples at the points.
std::vector<ColorSample>
color_samples(std::span<const DrawingPoint> points, const ColorField& field, double within);

/// The largest difference in red, green or blue.
double largest_difference(Color a, Color b);

/// That of a sample in sums of squares: errors are compared with what they may be.
double weight_of(const ColorSample& sample, double tolerance);

/// Weighted means: of the points, and of the squares and products of their ways from there.
struct Moments {
    DrawingPoint middle;
    double xx = 0;
    double xy = 0;
    double yy = 0;
};

/// Of one sample or more.
Moments moments_of(std::span<const ColorSample> samples, double tolerance);

} // namespace vera
