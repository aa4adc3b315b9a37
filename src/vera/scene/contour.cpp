// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/contour.h"

#include "vera/base/check.h"
#include "vera/math/bracketed_zero.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vera {

using Point = ContourPiece::Point;
using Kind = ContourPiece::Kind;

namespace {

Point mix(Point a, Point b, double v) {
    return {(1 - v) * a.r + v * b.r, (1 - v) * a.h + v * b.h};
}

Point difference(Point a, Point b) {
    return {a.r - b.r, a.h - b.h};
}

double dot(Point a, Point b) {
    return a.r * b.r + a.h * b.h;
}

double cross(Point a, Point b) {
    return a.r * b.h - a.h * b.r;
}

bool is_zero(Point a) {
    return a.r == 0 && a.h == 0;
}

} // namespace

Point point_at(const ContourPiece& piece, Point start, double v) {
    if (v <= 0)
        return start;
    if (v >= 1)
        return piece.end;
    switch (piece.kind) {
    case Kind::line:
        return mix(start, piece.end, v);
    case Kind::conic: {
        const double first = (1 - v) * (1 - v);
        const double middle = 2 * v * (1 - v) * piece.weight;
        const double last = v * v;
        const double sum = first + middle + last;
        return {
            (first * start.r + middle * piece.control[0].r + last * piece.end.r) / sum,
            (first * start.h + middle * piece.control[0].h + last * piece.end.h) / sum};
    }
    case Kind::cubic: {
        const Point a = mix(start, piece.control[0], v);
        const Point b = mix(piece.control[0], piece.control[1], v);
        const Point c = mix(piece.control[1], piece.end, v);
        return mix(mix(a, b, v), mix(b, c, v), v);
    }
    }
    VERA_CHECK(false && "a kind of contour piece");
}

Hodograph hodograph(const ContourPiece& piece, Point start) {
    const Point whole = difference(piece.end, start);
    const Point& control = piece.control[0];
    switch (piece.kind) {
    case Kind::line:
        return {{whole, whole, whole}};
    case Kind::conic: {
        // The numerator of the derivative of a rational quadratic curve is quadratic: its cubic
        // terms cancel.
        const Point first = difference(control, start);
        const Point last = difference(piece.end, control);
        return {
            {Point{piece.weight * first.r, piece.weight * first.h},
             Point{0.5 * whole.r, 0.5 * whole.h},
             Point{piece.weight * last.r, piece.weight * last.h}}};
    }
    case Kind::cubic:
        return {
            {difference(control, start),
             difference(piece.control[1], control),
             difference(piece.end, piece.control[1])}};
    }
    VERA_CHECK(false && "a kind of contour piece");
}

Point direction_at(const Hodograph& hodograph, double v) {
    const auto& [first, middle, last] = hodograph.coefficients;
    const Point direction = mix(mix(first, middle, v), mix(middle, last, v), v);
    if (!is_zero(direction))
        return direction;
    // The curve stands still: at an end it goes on towards the next control point.
    if (v <= 0)
        return is_zero(middle) ? last : middle;
    if (v >= 1)
        return is_zero(middle) ? first : middle;
    return difference(last, first);
}

QuadraticRoots inner_roots(double first, double middle, double last) {
    QuadraticRoots roots;
    const double leading = (first - middle) + (last - middle);
    const double half = middle - first;
    const double discriminant = half * half - leading * first;
    if (!(discriminant >= 0))
        return roots;
    const double root = std::sqrt(discriminant);
    const double larger = half > 0 ? -half - root : root - half;
    for (const double v : {larger / leading, first / larger})
        if (v > 0 && v < 1 && !(roots.count == 1 && roots.v[0] == v))
            roots.v[roots.count++] = v;
    if (roots.count == 2 && roots.v[1] < roots.v[0])
        std::swap(roots.v[0], roots.v[1]);
    return roots;
}

QuadraticRoots extremes(const Hodograph& hodograph, Point direction) {
    const auto& [first, middle, last] = hodograph.coefficients;
    return inner_roots(dot(first, direction), dot(middle, direction), dot(last, direction));
}

QuadraticRoots inflections(const Hodograph& hodograph) {
    const auto& [first, middle, last] = hodograph.coefficients;
    return inner_roots(cross(first, middle), 0.5 * cross(first, last), cross(middle, last));
}

double farthest_parameter(const ContourPiece& piece, Point start, Point direction) {
    double farthest = dot(piece.end, direction) > dot(start, direction) ? 1 : 0;
    if (piece.kind == Kind::line)
        return farthest;
    double reach = std::max(dot(piece.end, direction), dot(start, direction));
    const QuadraticRoots candidates = extremes(hodograph(piece, start), direction);
    for (std::size_t i = 0; i < candidates.count; ++i) {
        const double here = dot(point_at(piece, start, candidates.v[i]), direction);
        if (here > reach) {
            reach = here;
            farthest = candidates.v[i];
        }
    }
    return farthest;
}

double nearest_parameter(const ContourPiece& piece, Point start, Point point) {
    if (piece.kind == Kind::line) {
        const Point whole = difference(piece.end, start);
        const double v = dot(difference(point, start), whole) / dot(whole, whole);
        return v > 0 ? std::min(v, 1.0) : 0;
    }
    constexpr int samples = 32;
    int nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= samples; ++i) {
        const Point off = difference(point_at(piece, start, double{1.0 / samples} * i), point);
        if (dot(off, off) < least) {
            least = dot(off, off);
            nearest = i;
        }
    }

    // The nearest point is where the way to the given one is square to the curve.
    const Hodograph directions = hodograph(piece, start);
    const auto ahead = [&](double v) {
        return dot(difference(point_at(piece, start, v), point), direction_at(directions, v));
    };
    const double low = double{1.0 / samples} * std::max(nearest - 1, 0);
    const double high = double{1.0 / samples} * std::min(nearest + 1, samples);
    const double low_value = ahead(low);
    const double high_value = ahead(high);
    if (low_value >= 0)
        return low;
    if (high_value <= 0)
        return high;
    return bracketed_zero(low, low_value, high, high_value, ahead);
}

PlaceOnPiece nearest_place(const ContourPiece& piece, Point start, Point point) {
    const double v = nearest_parameter(piece, start, point);
    return {point_at(piece, start, v), direction_at(hodograph(piece, start), v)};
}

} // namespace vera
