// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/snapped_path.h"

#include "vera/base/check.h"
#include "vera/drawing/elliptic_arc.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>

namespace vera::detail {

namespace {

/// Doubles below this are whole numbers of units to a fraction that rounds right.
constexpr double most_units = 1e15;

/// The center of an arc of an SVG is found from its ends. Rounding these moves the far ends of flat
/// ellipses by as many times as much as they are longer than wide.
constexpr double flattest_arc = 4;

/// How far curves may be off the arcs that they stand for, in units.
constexpr double most_off = 0.5;

std::int64_t rounded(double units) {
    VERA_CHECK(std::abs(units) < most_units); // false for what is not a number
    return std::llround(units);
}

/// Path data of an SVG that is as short as its grammar allows.
class SvgPathWriter {
public:
    explicit SvgPathWriter(int digits)
        : digits_(digits) {}

    void write(const SnappedPath& path) {
        // An m at the very beginning counts from (0, 0). Numbers behind it are lines, relative too.
        begin('m');
        write_point(path.points.front());
        implied_ = 'l';
        at_ = path.points.front();
        for_each_segment(
            path,
            [&](SnappedPoint point) { write_line_to(point); },
            [&](const DrawingArc& arc, SnappedPoint point) { write_arc_to(arc, point); });
        implied_ = '\0';
        if (path.closed) {
            text_ += 'z';
            at_ = path.points.front(); // where z leads back to
        }
    }

    std::string take() { return std::move(text_); }

private:
    void write_line_to(SnappedPoint point) {
        if (point.y == at_.y) {
            begin('h');
            write(point.x - at_.x);
        } else if (point.x == at_.x) {
            begin('v');
            write(point.y - at_.y);
        } else {
            begin('l');
            write_point(point);
        }
        at_ = point;
    }

    /// A short one as a curve, which takes fewer bytes, and a flat one too. Others in parts of 90
    /// degrees at most: the center, which is found from the ends, is then off by no
    /// more than these, and no part is the larger one of two.
    void write_arc_to(const DrawingArc& arc, SnappedPoint point) {
        constexpr int angle_digits = 4;
        const double sweep = arc.end_degrees - arc.begin_degrees;
        const double a = distance(arc.ellipse.major, {});
        const double b = distance(arc.ellipse.minor, {});
        if (quadratic_error(arc) <= most_off) {
            begin('q');
            write_point(rounded_point(quadratic_control(arc)));
            write_point(point);
            at_ = point;
            return;
        }
        if (a > flattest_arc * b) {
            write_curves_to(arc, point);
            return;
        }
        double turn = rounded(a) == rounded(b) ? 0 : direction_degrees(arc.ellipse.major);
        turn = turn > 90 + 1e-6 ? turn - 180 : turn < -90 + 1e-6 ? turn + 180 : turn;
        const int parts = std::max(1, static_cast<int>(std::ceil(std::abs(sweep) / 90 - 1e-9)));
        for (int i = 1; i <= parts; ++i) {
            const SnappedPoint to = i == parts
                ? point
                : rounded_point(point_at(arc.ellipse, arc.begin_degrees + sweep * i / parts));
            begin('a');
            write(rounded(a));
            write(rounded(b));
            write(decimal(turn, angle_digits));
            write("0");
            write(sweep > 0 ? "1" : "0");
            write_point(to);
            at_ = to;
        }
    }

    void write_curves_to(const DrawingArc& arc, SnappedPoint point) {
        for (const SnappedCurve& curve : curves_along(arc, point)) {
            begin('c');
            for (const SnappedPoint to : {curve.first, curve.second, curve.end})
                write_point(to);
            at_ = curve.end;
        }
    }

    void begin(char command) {
        if (command == implied_)
            return;
        text_ += command;
        implied_ = command;
        last_ = Last::command;
    }

    void write_point(SnappedPoint point) {
        write(point.x - at_.x);
        write(point.y - at_.y);
    }

    void write(std::int64_t units) { write(decimal(units, digits_)); }

    void write(const std::string& number) {
        const bool ends_the_last = number.front() == '-' || last_ == Last::command
            || (number.front() == '.' && last_ == Last::fraction);
        if (!ends_the_last)
            text_ += ' ';
        text_ += number;
        last_ = number.find('.') == std::string::npos ? Last::integer : Last::fraction;
    }

    enum class Last { command, integer, fraction };

    int digits_;
    std::string text_;
    SnappedPoint at_;
    char implied_ = '\0'; ///< the command that further numbers would repeat
    Last last_ = Last::command;
};

/// What is left of a chain with these arcs; nothing when no length is.
std::optional<SnappedPath> snapped(
    std::span<const DrawingPoint> points,
    bool closed,
    std::span<const DrawingArc> arcs,
    const Lattice& lattice) {
    if (points.empty())
        return std::nullopt;
    SnappedPath line = {{lattice.snapped(points.front())}, closed, {}};
    auto arc = arcs.begin();
    const std::size_t segments = points.size() - (closed ? 0 : 1);
    for (std::size_t i = 0; i < segments; ++i) {
        const bool is_arc = arc != arcs.end() && arc->segment == i;
        const bool is_long = is_arc && std::abs(arc->end_degrees - arc->begin_degrees) >= 90;
        const bool leads_back = i + 1 == points.size();
        const SnappedPoint to = lattice.snapped(points[leads_back ? 0 : i + 1]);
        if (is_long || to != line.points.back()) {
            if (is_arc) {
                line.arcs.push_back(lattice.in_units(*arc));
                line.arcs.back().segment = line.points.size() - 1;
            }
            if (!leads_back)
                line.points.push_back(to);
        }
        arc += is_arc ? 1 : 0;
    }
    const auto leads_back_straight = [&] {
        return line.arcs.empty() || line.arcs.back().segment + 1 < line.points.size();
    };
    while (closed && line.points.size() > 1 && line.points.back() == line.points.front()
           && leads_back_straight())
        line.points.pop_back();
    if (line.points.size() < 2 && line.arcs.empty())
        return std::nullopt;
    return line;
}

/// How far the arc is off its chord where it is farthest, in pixels; of more than half a turn, its
/// larger axis.
double height(const DrawingArc& arc) {
    const double sweep = arc.end_degrees - arc.begin_degrees;
    if (std::abs(sweep) > 180)
        return distance(arc.ellipse.major, {});
    const DrawingPoint a = point_at(arc.ellipse, arc.begin_degrees);
    const DrawingPoint b = point_at(arc.ellipse, arc.end_degrees);
    // There the tangent runs along the chord.
    const DrawingPoint middle = point_at(arc.ellipse, arc.begin_degrees + sweep / 2);
    return distance(middle, {(a.x + b.x) / 2, (a.y + b.y) / 2});
}

} // namespace

Lattice::Lattice(double precision) {
    VERA_CHECK(precision > 0 && std::isfinite(precision));
    constexpr int most_digits = 6;
    while (digits_ < most_digits && 1 / units_per_pixel_ > precision) {
        ++digits_;
        units_per_pixel_ *= 10;
    }
}

SnappedPoint Lattice::snapped(DrawingPoint point) const {
    return {rounded(point.x * units_per_pixel_), rounded(point.y * units_per_pixel_)};
}

DrawingArc Lattice::in_units(const DrawingArc& arc) const {
    const auto scaled = [&](DrawingPoint point) {
        return DrawingPoint{point.x * units_per_pixel_, point.y * units_per_pixel_};
    };
    DrawingArc result = arc;
    result.ellipse = {
        scaled(arc.ellipse.center), scaled(arc.ellipse.major), scaled(arc.ellipse.minor)};
    return result;
}

SnappedPoint rounded_point(DrawingPoint in_units) {
    return {rounded(in_units.x), rounded(in_units.y)};
}

std::vector<SnappedPoint>
snapped_points(std::span<const DrawingPoint> points, const Lattice& lattice) {
    std::vector<SnappedPoint> snapped;
    snapped.reserve(points.size());
    for (const DrawingPoint point : points)
        if (const SnappedPoint next = lattice.snapped(point);
            snapped.empty() || next != snapped.back())
            snapped.push_back(next);
    return snapped;
}

std::vector<SnappedCurve> curves_along(const DrawingArc& arc, SnappedPoint end) {
    const int parts = bezier_parts(arc, most_off);
    const auto angle = [&](int part) {
        return arc.begin_degrees + (arc.end_degrees - arc.begin_degrees) * part / parts;
    };
    std::vector<SnappedCurve> curves;
    for (int i = 0; i < parts; ++i) {
        const auto [first, second] = bezier_controls(arc.ellipse, angle(i), angle(i + 1));
        curves.push_back(
            {rounded_point(first),
             rounded_point(second),
             i + 1 == parts ? end : rounded_point(point_at(arc.ellipse, angle(i + 1)))});
    }
    return curves;
}

std::vector<SnappedPath> snapped_rings(const FilledOutline& fill, const Lattice& lattice) {
    constexpr double straight = 0.5; // units
    std::vector<SnappedPath> rings;
    for (std::size_t i = 0; i < fill.rings.size(); ++i) {
        std::vector<DrawingArc> arcs;
        if (i < fill.arcs.size())
            for (const DrawingArc& arc : fill.arcs[i])
                if (height(arc) * lattice.units_per_pixel() > straight)
                    arcs.push_back(arc);
        std::optional<SnappedPath> ring = snapped(fill.rings[i], true, arcs, lattice);
        if (ring && (ring->points.size() >= 3 || !ring->arcs.empty()))
            rings.push_back(std::move(*ring));
    }
    return rings;
}

std::optional<SnappedPath> snapped_line(const Stroke& stroke, const Lattice& lattice) {
    std::optional<SnappedPath> line = snapped(stroke.points, stroke.closed, stroke.arcs, lattice);
    if (line && line->points.size() == 2 && line->arcs.empty())
        line->closed = false; // there and back is there
    return line;
}

std::string decimal(std::int64_t units, int digits) {
    std::array<char, 20> text; // of 2^63 - 1
    const char* const begin = text.data();
    const char* end = std::to_chars(text.data(), text.data() + text.size(), std::abs(units)).ptr;
    const std::ptrdiff_t before_point = end - begin - digits; // less than 0: so many zeros follow
    const char* const point = begin + std::max<std::ptrdiff_t>(before_point, 0);
    while (end > point && end[-1] == '0')
        --end;
    if (end == begin)
        return "0";
    std::string number(units < 0 ? "-" : "");
    number.append(begin, point);
    if (end > point) {
        number += '.';
        if (before_point < 0)
            number.append(static_cast<std::size_t>(-before_point), '0');
        number.append(point, end);
    }
    return number;
}

std::string decimal(double number, int digits) {
    double units = number;
    for (int i = 0; i < digits; ++i)
        units *= 10;
    return decimal(rounded(units), digits);
}

std::string svg_path_data(std::span<const SnappedPath> paths, int digits) {
    SvgPathWriter writer(digits);
    for (const SnappedPath& path : paths)
        writer.write(path);
    return writer.take();
}

} // namespace vera::detail
