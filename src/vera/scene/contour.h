// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/primitives.h"

#include <array>
#include <cstddef>

namespace vera {

/// The point of the piece at parameter v from 0 (its start) to 1 (its end), both exactly.
ContourPiece::Point point_at(const ContourPiece& piece, ContourPiece::Point start, double v);

/// The directions of a piece: up to a positive factor its derivative is the quadratic curve with
/// these Bernstein coefficients.
struct Hodograph {
    std::array<ContourPiece::Point, 3> coefficients;
};

Hodograph hodograph(const ContourPiece& piece, ContourPiece::Point start);

/// The direction in which the piece goes at v, of any length; where it stands still (a control
/// point on an end point), the one in which it goes on.
ContourPiece::Point direction_at(const Hodograph& hodograph, double v);

/// Up to two parameters strictly between 0 and 1, in order.
struct QuadraticRoots {
    std::size_t count = 0;
    std::array<double, 2> v = {};
};

/// The zeros of the quadratic polynomial with these Bernstein coefficients.
QuadraticRoots inner_roots(double first, double middle, double last);

/// Where the piece turns back against the direction, or for it.
QuadraticRoots extremes(const Hodograph& hodograph, ContourPiece::Point direction);

/// Where the piece changes from turning left to turning right, or back.
QuadraticRoots inflections(const Hodograph& hodograph);

/// The parameter of the point of the piece that is farthest in the direction.
double farthest_parameter(
    const ContourPiece& piece, ContourPiece::Point start, ContourPiece::Point direction);

/// The parameter of the point of the piece nearest to the given one.
double
nearest_parameter(const ContourPiece& piece, ContourPiece::Point start, ContourPiece::Point point);

/// A point of a piece, and the direction in which the piece goes there: see direction_at().
struct PlaceOnPiece {
    ContourPiece::Point point;
    ContourPiece::Point direction;
};

/// Of the point of the piece nearest to the given one.
PlaceOnPiece
nearest_place(const ContourPiece& piece, ContourPiece::Point start, ContourPiece::Point point);

} // namespace vera
