// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/contour_reader.h"

#include "vera/formats/vera_keywords.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace vera {

namespace {

using Point = ContourPiece::Point;

Point operator+(Point a, Point b) {
    return {a.r + b.r, a.h + b.h};
}

Point operator-(Point a, Point b) {
    return {a.r - b.r, a.h - b.h};
}

Point operator*(double factor, Point a) {
    return {factor * a.r, factor * a.h};
}

double dot(Point a, Point b) {
    return a.r * b.r + a.h * b.h;
}

double cross(Point a, Point b) {
    return a.r * b.h - a.h * b.r;
}

double size_of(Point a) {
    return std::max(std::abs(a.r), std::abs(a.h));
}

/// Whether the point lies on the line through the others, as far as rounding can tell.
bool on_one_line(Point a, Point b, Point c) {
    const double coordinate = std::max({size_of(a), size_of(b), size_of(c)});
    const double side = std::max(size_of(b - a), size_of(c - a));
    // As for the area of faces: each coordinate is rounded to 53 bits.
    return !(std::abs(cross(b - a, c - a)) > 0x1p-50 * coordinate * side);
}

struct Circle {
    Point center;
    double radius = 0;
};

Circle circle_through(Point a, Point b, Point c) {
    const Point u = b - a;
    const Point v = c - a;
    const double twice_area = 2 * cross(u, v);
    const Point offset = {
        (dot(u, u) * v.h - dot(v, v) * u.h) / twice_area,
        (dot(v, v) * u.r - dot(u, u) * v.r) / twice_area};
    return {a + offset, std::sqrt(dot(offset, offset))};
}

/// Whether a curve goes round its centre as the clock's hands do, seen with r to the right and h
/// upwards.
enum class Sense { clockwise, counterclockwise };

/// Adds the arc of the circle that goes from start to end in that sense, cut in two at most so
/// many times over.
void add_arc(
    const Circle& circle,
    Point start,
    Point end,
    Sense sense,
    int cuts,
    std::vector<ContourPiece>& pieces) {
    const Point chord = end - start;
    const double length = std::sqrt(dot(chord, chord));
    const Point right = {chord.h / length, -chord.r / length};
    const Point outward = sense == Sense::counterclockwise ? right : -1 * right;

    // The cosine of half the arc's angle. An arc of more than 120 degrees is cut in two: as one
    // piece it would have a control point far away, or, from 180 degrees on, none.
    const double cosine = dot(0.5 * (start + end) - circle.center, outward) / circle.radius;
    constexpr double smallest_cosine = 0.5 - 0x1p-20;
    if (cosine < smallest_cosine && cuts > 0) {
        Point middle = circle.center + circle.radius * outward;
        // An arc that touches the axis in its middle.
        if (std::abs(middle.r) <= 0x1p-40 * circle.radius)
            middle.r = 0;
        add_arc(circle, start, middle, sense, cuts - 1, pieces);
        add_arc(circle, middle, end, sense, cuts - 1, pieces);
        return;
    }
    ContourPiece piece;
    piece.kind = ContourPiece::Kind::conic;
    piece.control[0] = circle.center + (circle.radius / cosine) * outward;
    piece.weight = cosine;
    piece.end = end;
    pieces.push_back(piece);
}

/// Whether r < 0 somewhere along the piece, by more than rounding.
bool leaves_half_plane(Point start, const ContourPiece& piece) {
    if (piece.kind == ContourPiece::Kind::line)
        return false; // its ends were looked at
    const double size = std::max({size_of(start), size_of(piece.control[0]), size_of(piece.end)});
    // The pieces of an arc have ends that were not written.
    if (piece.end.r < 0)
        return true;
    if (piece.kind == ContourPiece::Kind::conic) {
        // A quadratic with coefficients a, b, c >= 0 in Bernstein's form is negative somewhere
        // between its ends just when b < -sqrt(a c).
        const double b = piece.weight * piece.control[0].r;
        return b < -std::sqrt(start.r * piece.end.r) - 0x1p-40 * size * std::max(1.0, piece.weight);
    }
    // The least r of a cubic is at an end or where its derivative, a t^2 + 2 b t + c, is zero.
    const double r0 = start.r;
    const double r1 = piece.control[0].r;
    const double r2 = piece.control[1].r;
    const double r3 = piece.end.r;
    const double a = r3 - r0 + 3 * (r1 - r2);
    const double b = r0 - 2 * r1 + r2;
    const double c = r1 - r0;
    const double least = -0x1p-40 * std::max(size, size_of(piece.control[1]));
    const double discriminant = b * b - a * c;
    if (discriminant < 0)
        return false;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    for (const double t : {q / a, c / q}) {
        if (!(t > 0 && t < 1))
            continue;
        const double s = 1 - t;
        const double r = s * s * s * r0 + 3 * s * s * t * r1 + 3 * s * t * t * r2 + t * t * t * r3;
        if (r < least)
            return true;
    }
    return false;
}

std::optional<Point> read_point(WordReader& words, const char* r_name, const char* h_name) {
    const auto r = words.take_number(r_name);
    if (!r)
        return std::nullopt;
    const auto h = words.take_number(h_name);
    if (!h)
        return std::nullopt;
    return Point{*r, *h};
}

/// A point that the contour passes through: r >= 0.
std::optional<Point> read_contour_point(WordReader& words, const char* r_name, const char* h_name) {
    const WordPlace place = words.place();
    const auto point = read_point(words, r_name, h_name);
    if (point && point->r < 0) {
        words.complaints().error(
            place,
            fmt::format("{} is {}, but distances from the axis are not negative", r_name, point->r),
            "the contour is one half of the outline; the other half follows from it");
        return std::nullopt;
    }
    return point;
}

using Pieces = std::optional<std::vector<ContourPiece>>;

/// GE r h
Pieces read_line(WordReader& words) {
    const auto end = read_contour_point(words, "the r where the line ends", "the h where it ends");
    if (!end)
        return std::nullopt;
    ContourPiece piece;
    piece.end = *end;
    return std::vector{piece};
}

/// KR rm hm r h
Pieces read_arc(WordReader& words, const WordPlace& keyword, Point start) {
    const auto middle =
        read_contour_point(words, "the r of a point on the arc", "the h of the point on the arc");
    if (!middle)
        return std::nullopt;
    const auto end = read_contour_point(words, "the r where the arc ends", "the h where it ends");
    if (!end)
        return std::nullopt;
    if (on_one_line(start, *middle, *end)) {
        words.complaints().error(
            keyword,
            "the arc's three points are on one line, so that no circle passes through them",
            "write GE for a straight line; make a whole circle of two arcs");
        return std::nullopt;
    }
    const Sense sense =
        cross(*middle - start, *end - *middle) > 0 ? Sense::counterclockwise : Sense::clockwise;
    // Less than a whole turn: four pieces of less than 90 degrees.
    constexpr int most_cuts = 2;
    std::vector<ContourPiece> pieces;
    add_arc(circle_through(start, *middle, *end), start, *end, sense, most_cuts, pieces);
    // Rounding leaves no circle through points that are almost on a line and far apart or huge.
    const bool usable = std::all_of(pieces.begin(), pieces.end(), [](const ContourPiece& piece) {
        return piece.weight > 0.25 && std::isfinite(piece.control[0].r)
            && std::isfinite(piece.control[0].h);
    });
    if (!usable) {
        words.complaints().error(
            keyword,
            "the arc's three points are too far apart, or too close to one line, for a circle",
            "write GE for a straight line");
        return std::nullopt;
    }
    return pieces;
}

/// KE rc hc w r h
Pieces read_conic(WordReader& words, const WordPlace& keyword, Point start) {
    const auto control =
        read_point(words, "the r of the control point", "the h of the control point");
    if (!control)
        return std::nullopt;
    const WordPlace weight_place = words.place();
    const auto weight = words.take_number("the weight of the control point");
    if (!weight)
        return std::nullopt;
    const auto end = read_contour_point(words, "the r where the arc ends", "the h where it ends");
    if (!end)
        return std::nullopt;
    if (!(*weight > 0)) {
        words.complaints().error(
            weight_place,
            fmt::format("the weight of the control point is {}, but must be positive", *weight),
            "below 1 the arc is part of an ellipse, at 1 a parabola, above 1 a hyperbola");
        return std::nullopt;
    }
    if (on_one_line(start, *control, *end)) {
        words.complaints().error(
            keyword,
            "the arc's control point is on one line with its ends",
            "write GE for a straight line");
        return std::nullopt;
    }
    ContourPiece piece;
    piece.kind = ContourPiece::Kind::conic;
    piece.control[0] = *control;
    piece.weight = *weight;
    piece.end = *end;
    return std::vector{piece};
}

/// KU r1 h1 r2 h2 r h
Pieces read_cubic(WordReader& words) {
    const auto first =
        read_point(words, "the r of the first control point", "the h of the first control point");
    if (!first)
        return std::nullopt;
    const auto second =
        read_point(words, "the r of the second control point", "the h of the second control point");
    if (!second)
        return std::nullopt;
    const auto end = read_contour_point(words, "the r where the curve ends", "the h where it ends");
    if (!end)
        return std::nullopt;
    ContourPiece piece;
    piece.kind = ContourPiece::Kind::cubic;
    piece.control = {*first, *second};
    piece.end = *end;
    return std::vector{piece};
}

Pieces read_pieces(WordReader& words, std::string_view keyword, Point start) {
    words.take();
    const WordPlace place = words.last_place();
    Pieces pieces = keyword == "GE" ? read_line(words)
        : keyword == "KR"           ? read_arc(words, place, start)
        : keyword == "KE"           ? read_conic(words, place, start)
                                    : read_cubic(words);
    if (!pieces)
        return std::nullopt;
    Point from = start;
    for (const ContourPiece& piece : *pieces) {
        if (leaves_half_plane(from, piece)) {
            words.complaints().error(
                place,
                "the curve crosses the axis: r is negative along a part of it",
                "end it at r = 0, or move its inner points away from the axis");
            return std::nullopt;
        }
        from = piece.end;
    }
    return pieces;
}

bool has_area(Point start, const ContourPiece& piece) {
    switch (piece.kind) {
    case ContourPiece::Kind::line:
        return start != piece.end && (start.r > 0 || piece.end.r > 0);
    case ContourPiece::Kind::conic:
        return true;
    case ContourPiece::Kind::cubic:
        break;
    }
    const auto& [first, second] = piece.control;
    const bool on_axis = start.r == 0 && first.r == 0 && second.r == 0 && piece.end.r == 0;
    return !on_axis && (start != first || first != second || second != piece.end);
}

} // namespace

std::optional<std::vector<Contour>> read_contour(WordReader& words) {
    if (words.peek() != "AN") {
        words.expected("AN, which begins the contour");
        return std::nullopt;
    }
    words.take();
    const WordPlace beginning = words.last_place();
    const auto start = read_contour_point(
        words, "the r where the contour begins", "the h where the contour begins");
    if (!start)
        return std::nullopt;

    std::vector<Contour> contours = {{*start, {}}};
    Point from = *start;
    bool any = false;
    const auto is_piece = [](std::string_view word) {
        return std::find(contour_words.begin(), contour_words.end(), word) != contour_words.end();
    };
    for (std::string_view word = words.peek(); is_piece(word); word = words.peek()) {
        const WordPlace place = words.place();
        const auto pieces = read_pieces(words, word, from);
        if (!pieces)
            return std::nullopt;
        any = true;
        for (const ContourPiece& piece : *pieces) {
            if (has_area(from, piece)) {
                contours.back().pieces.push_back(piece);
            } else {
                words.complaints().warn(
                    "pieces of contours without area",
                    place,
                    "this piece of the contour has no area and is left out",
                    "a contour need not be closed along the axis");
                if (piece.end != from)
                    contours.push_back({piece.end, {}});
            }
            from = piece.end;
        }
    }
    if (!any)
        words.complaints().warn(
            "contours of one point",
            beginning,
            "this contour has no pieces, so that there is no surface",
            "go on with GE, KR, KE or KU");
    contours.erase(
        std::remove_if(
            contours.begin(),
            contours.end(),
            [](const Contour& contour) { return contour.pieces.empty(); }),
        contours.end());
    return contours;
}

} // namespace vera
