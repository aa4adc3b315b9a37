// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/snapped_path.h"

#include "vera/base/check.h"
#include "vera/drawing/elliptic_arc.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>

namespace vera::detail {

namespace {

/// All that have 64 bits, but for the largest.
constexpr auto powers_of_ten = [] {
    std::array<std::uint64_t, 19> powers = {1};
    for (std::size_t i = 1; i < powers.size(); ++i)
        powers[i] = 10 * powers[i - 1];
    return powers;
}();

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

std::int64_t rounded(double number, int digits) {
    double units = number;
    for (int i = 0; i < digits; ++i)
        units *= 10;
    return rounded(units);
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

char* write_decimal(char* to, std::int64_t units, int digits) {
    VERA_CHECK(static_cast<std::size_t>(digits) < powers_of_ten.size());
    const auto size = static_cast<std::uint64_t>(std::abs(units));
    const std::uint64_t unit = powers_of_ten[static_cast<std::size_t>(digits)];
    const std::uint64_t whole = size / unit;
    std::uint64_t fraction = size % unit;
    if (size == 0) {
        *to++ = '0';
        return to;
    }
    if (units < 0)
        *to++ = '-';
    constexpr std::ptrdiff_t most_digits = 20;
    if (whole > 0)
        to = std::to_chars(to, to + most_digits, whole).ptr;
    if (fraction > 0) {
        *to++ = '.';
        int places = digits;
        for (; fraction % 10 == 0; fraction /= 10)
            --places;
        for (int place = places; place-- > 0; fraction /= 10)
            to[place] = static_cast<char>('0' + fraction % 10);
        to += places;
    }
    return to;
}

std::string decimal(std::int64_t units, int digits) {
    std::string text(longest_decimal(digits), '\0');
    text.resize(static_cast<std::size_t>(write_decimal(text.data(), units, digits) - text.data()));
    return text;
}

std::string decimal(double number, int digits) {
    return decimal(rounded(number, digits), digits);
}

} // namespace vera::detail
