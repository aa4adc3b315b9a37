// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/check.h"
#include "vera/drawing/drawing.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vera::detail {

/// How far curves may be off the arcs that they stand for, in units.
constexpr double most_off = 0.5;

/// In units of a Lattice.
struct SnappedPoint {
    std::int64_t x = 0;
    std::int64_t y = 0;

    friend bool operator==(const SnappedPoint&, const SnappedPoint&) = default;
};

/// A chain of points of which no two neighbours are equal, unless an arc of 90 degrees or more
/// leads from one to the other; in a closed one, the last and the first are neighbours.
struct SnappedPath {
    std::vector<SnappedPoint> points;
    bool closed = false;
    std::vector<DrawingArc> arcs = {}; ///< as those of a Stroke, but in units of the Lattice
};

/// Calls line_to(SnappedPoint) or arc_to(DrawingArc, SnappedPoint) for each segment of the path in
/// their order; of a closed one with the last, which leads back, only if it is an arc.
template <typename LineTo, typename ArcTo>
void for_each_segment(const SnappedPath& path, const LineTo& line_to, const ArcTo& arc_to) {
    auto arc = path.arcs.begin();
    for (std::size_t i = 0; i < path.points.size(); ++i) {
        const bool is_last = i + 1 == path.points.size();
        const SnappedPoint to = path.points[is_last ? 0 : i + 1];
        if (arc != path.arcs.end() && arc->segment == i)
            arc_to(*arc++, to);
        else if (!is_last)
            line_to(to);
    }
}

/// The points that coordinates are rounded to: multiples of a power of a tenth of a pixel. Every
/// point is rounded once, by itself, so that outlines that abut still do.
class Lattice {
public:
    /// The coarsest lattice that is no coarser than the precision, which is in pixels.
    explicit Lattice(double precision);

    /// Digits behind the point of a coordinate in pixels.
    int digits() const { return digits_; }

    double units_per_pixel() const { return units_per_pixel_; }

    SnappedPoint snapped(DrawingPoint point) const;

    /// In units, not rounded.
    DrawingArc in_units(const DrawingArc& arc) const;

private:
    int digits_ = 0;
    double units_per_pixel_ = 1;
};

/// The nearest whole number, of two the one farther from 0. It must be finite, and less than 1e15,
/// below which doubles have the fraction that rounding asks for.
inline std::int64_t rounded(double units) {
    constexpr double most_units = 1e15;
    VERA_CHECK(std::abs(units) < most_units); // false for what is not a number
    // Half a unit less a bit: the sum with it is rounded up to 1 only from a half on.
    constexpr double almost_half = 0x1.fffffffffffffp-2;
    return static_cast<std::int64_t>(units + std::copysign(almost_half, units));
}

/// In units of 10^-digits, rounded.
std::int64_t rounded(double number, int digits);

/// A point in units, rounded.
SnappedPoint rounded_point(DrawingPoint in_units);

/// The points after rounding, each but once where several in a row are equal.
std::vector<SnappedPoint>
snapped_points(std::span<const DrawingPoint> points, const Lattice& lattice);

/// The rings of the area that are left after rounding; all closed, of three points or more, or with
/// an arc. Arcs that are nowhere farther than half a unit off their chord are straight.
std::vector<SnappedPath> snapped_rings(const FilledOutline& fill, const Lattice& lattice);

/// Nothing when no length is left.
std::optional<SnappedPath> snapped_line(const Stroke& stroke, const Lattice& lattice);

/// A cubic Bezier curve, from where the one before it ended.
struct SnappedCurve {
    SnappedPoint first; ///< the control points
    SnappedPoint second;
    SnappedPoint end;
};

/// Curves along the arc, which is in units, to its end: no farther off it than half a unit.
std::vector<SnappedCurve> curves_along(const DrawingArc& arc, SnappedPoint end);

/// A number of units of 10^-digits as a decimal, with nothing that can be left out: "-.5", "12".
std::string decimal(std::int64_t units, int digits);

/// At most as many bytes as a decimal takes: a sign, a point, zeros behind it, and digits.
constexpr std::size_t longest_decimal(int digits) {
    return 22 + static_cast<std::size_t>(digits);
}

/// The same to where there is room for the longest; returns where it ends.
char* write_decimal(char* to, std::int64_t units, int digits);

/// The number rounded to that many digits behind the point. It must be finite, and below 1e15 in
/// units of the last digit.
std::string decimal(double number, int digits);

} // namespace vera::detail
