// SPDX-License-Identifier: Apache-2.0
// How colours go along a gradient, and where stops of it are worth most.
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/math/color.h"
#include "vera/visible/color_samples.h"

#include <cstddef>
#include <span>
#include <vector>

namespace vera {

/// How the colours of samples go along one parameter from 0 to 1, as a polygonal line: the values
/// at the knots of least squares. The samples are sorted by the parameter, so that those between
/// two knots follow each other.
class ColorProfile {
public:
    /// Along the gradient, whose stops do not matter, with a knot at the first sample and one at
    /// the last. There must be a sample.
    ColorProfile(const Gradient& gradient, std::span<const ColorSample> samples, double tolerance);

    /// Whether there are two knots.
    bool has_extent() const { return knots_.back().offset > knots_.front().offset; }

    /// The stops for the knots that there are.
    std::vector<GradientStop> stops() const;

    /// How far off these stops at the knots are, at most.
    double largest_error(std::span<const GradientStop> stops) const;

    /// A knot more: at the sample that is farthest off the lines between the samples at the knots
    /// that there are, which finds the bends of a profile (Ramer 1972, Douglas and Peucker 1973).
    /// False where there is no room.
    bool add_knot();

private:
    struct Along {
        double offset = 0;
        double part = 0; ///< of the way from the knot before it to the next one
        double weight = 1;
        double slack = 0;
        Color color;

        double error(Color painted) const { return largest_difference(painted, color) - slack; }
    };

    struct Knot {
        double offset = 0;
        std::size_t first = 0;  ///< sample that is there or after it
        std::size_t sample = 0; ///< one that is there
    };

    std::span<const Along> samples_after(std::size_t knot) const;
    void place_samples_after(std::size_t knot);
    std::vector<Color> values_at_knots() const;

    std::vector<Along> along_; ///< the samples, by offset
    std::vector<Knot> knots_;
};

} // namespace vera
