// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/contour.h"
#include "vera/scene/curved_facets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "scene/contour_pieces.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using test::cubic_to;
using test::line_to;
using test::quarter_to;
using Point = ContourPiece::Point;

constexpr std::size_t most = 1 << 20;
constexpr double infinity = std::numeric_limits<double>::infinity();

RotationalShape shape_of(Point start, std::vector<ContourPiece> contour) {
    RotationalShape shape;
    shape.base = {1, 2, 3};
    shape.axis = normalized({1, -2, 2});
    shape.start = start;
    shape.contour = std::move(contour);
    return shape;
}

RotationalShape ball() {
    return shape_of({0, -1}, {quarter_to({1, 0}, {1, -1}), quarter_to({0, 1}, {1, 1})});
}

RotationalShape torus() {
    return shape_of(
        {2.5, 0},
        {quarter_to({2, 0.5}, {2.5, 0.5}),
         quarter_to({1.5, 0}, {1.5, 0.5}),
         quarter_to({2, -0.5}, {1.5, -0.5}),
         quarter_to({2.5, 0}, {2.5, -0.5})});
}

/// A cone with a tip, a thin neck and a broad plate, with plane rings.
RotationalShape candlestick() {
    return shape_of(
        {0, 0},
        {line_to({20, 0}),
         line_to({20, 1}),
         line_to({0.5, 1}),
         line_to({0.5, 1}), // of no length
         line_to({0.5, 10}),
         line_to({3, 12}),
         line_to({0, 20})});
}

/// Curves with inflections, and one that goes from the axis to the axis.
RotationalShape vase() {
    return shape_of(
        {0, -2},
        {line_to({2, -2}),
         line_to({1, -1}),
         cubic_to({1, 1}, {-0.25, -0.5}, {2.5, 0.5}),
         line_to({0, 1})});
}

/// Touches the axis half way up.
RotationalShape hourglass() {
    const double third = 1.0 / 3;
    return shape_of({1, 0}, {cubic_to({1, 2}, {-third, 2 * third}, {-third, 4 * third})});
}

RotationalShape drop() {
    return shape_of({0, 0}, {cubic_to({0, 2}, {3, -1}, {2, 4})});
}

LocalDeviation everywhere(double deviation) {
    return [deviation](Vec3) { return deviation; };
}

/// How far a point is from the surface.
double distance_from(const Sphere& sphere, Vec3 point, std::uint32_t) {
    return std::abs(length(point - sphere.center) - sphere.radius);
}

double distance_from(const RotationalShape& shape, Vec3 point, std::uint32_t piece) {
    const Vec3 from_base = point - shape.base;
    const double h = dot(from_base, shape.axis);
    const double r = length(from_base - h * shape.axis);
    const Point start = piece == 0 ? shape.start : shape.contour[piece - 1].end;
    const ContourPiece& contour = shape.contour[piece];
    const Point at = point_at(contour, start, nearest_parameter(contour, start, {r, h}));
    return std::hypot(at.r - r, at.h - h);
}

template <typename Primitive>
void expect_near_surface(
    const Primitive& primitive, const LocalDeviation& deviation, double rounding) {
    const CurvedFacets facets = curved_facets(primitive, deviation, most);
    double farthest = 0;
    for (const auto& triangle : facets.triangles) {
        const Vec3 a = facets.corners[triangle.corners[0]];
        const Vec3 b = facets.corners[triangle.corners[1]];
        const Vec3 c = facets.corners[triangle.corners[2]];
        for (const Vec3 corner : {a, b, c})
            ASSERT_LE(distance_from(primitive, corner, triangle.piece), rounding);
        for (int i = 0; i <= 3; ++i)
            for (int j = 0; i + j <= 3; ++j) {
                const Vec3 point = i / 3.0 * a + j / 3.0 * b + (3 - i - j) / 3.0 * c;
                const double off = distance_from(primitive, point, triangle.piece);
                ASSERT_LE(off, deviation(point) * (1 + 1e-9) + rounding);
                farthest = std::max(farthest, off / deviation(point));
            }
    }
    EXPECT_GT(farthest, 0.1) << "finer than was asked for";
}

/// Every edge has a triangle on either side. Returns the Euler characteristic.
int expect_closed(const CurvedFacets& facets) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    std::set<std::uint32_t> corners;
    for (const auto& triangle : facets.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t from = triangle.corners[i];
            const std::uint32_t to = triangle.corners[(i + 1) % 3];
            EXPECT_NE(from, to);
            ++edges[{from, to}];
            corners.insert(from);
        }
    for (const auto& [edge, count] : edges) {
        EXPECT_EQ(count, 1);
        EXPECT_EQ(edges.count({edge.second, edge.first}), 1U);
    }
    return static_cast<int>(corners.size()) - static_cast<int>(edges.size() / 2)
        + static_cast<int>(facets.triangles.size());
}

/// Six times the volume that they enclose, positive where they face outwards.
double volume(const CurvedFacets& facets) {
    double sum = 0;
    const Vec3 origin = facets.corners[0];
    for (const auto& triangle : facets.triangles) {
        const auto& [a, b, c] = triangle.corners;
        sum +=
            dot(facets.corners[a] - origin,
                cross(facets.corners[b] - origin, facets.corners[c] - origin));
    }
    return sum / 6;
}

/// Finer near a point, as a perspective asks for.
LocalDeviation near(Vec3 eye, double part) {
    return [eye, part](Vec3 point) { return part * length(point - eye); };
}

TEST(CurvedFacets, AreClosedAndFaceOutwards) {
    const double pi = 3.141592653589793;
    for (const LocalDeviation& deviation :
         {everywhere(0.2),
          everywhere(0.004),
          everywhere(infinity),
          near({1.51, 2.7, 3.57}, 0.01),
          near({1, 3.0001, 3}, 0.01),
          near({1, 3, 3}, 0.01)}) {
        const double part = deviation({0, 0, 0}) > 0.005 ? 0.5 : 0.96;
        const CurvedFacets of_sphere = curved_facets(Sphere{{1, 2, 3}, 1}, deviation, most);
        EXPECT_EQ(expect_closed(of_sphere), 2);
        EXPECT_GT(volume(of_sphere), part * 4 / 3 * pi);
        EXPECT_LT(volume(of_sphere), 4.0 / 3 * pi);
        for (const RotationalShape& shape : {ball(), candlestick(), vase(), drop()}) {
            const CurvedFacets facets = curved_facets(shape, deviation, most);
            EXPECT_EQ(expect_closed(facets), 2);
            EXPECT_GT(volume(facets), 0);
        }
        const CurvedFacets of_torus = curved_facets(torus(), deviation, most);
        EXPECT_EQ(expect_closed(of_torus), 0);
        EXPECT_GT(volume(of_torus), part * 2 * pi * pi * 2 * 0.25);
    }
}

TEST(CurvedFacets, AreAsNearAsWasAskedFor) {
    for (const double deviation : {0.1, 0.004, 0.0005}) {
        expect_near_surface(Sphere{{1, 2, 3}, 1}, everywhere(deviation), 1e-15);
        for (const RotationalShape& shape :
             {ball(), torus(), candlestick(), vase(), drop(), hourglass()})
            expect_near_surface(shape, everywhere(deviation), 1e-7 * deviation);
    }
}

TEST(CurvedFacets, AreFinerWhereMoreIsAskedFor) {
    for (const Vec3 eye : {Vec3{1, 2, 4.01}, Vec3{2.1, 2.1, 3}, Vec3{1, 2, 3}}) {
        expect_near_surface(Sphere{{1, 2, 3}, 1}, near(eye, 0.01), 1e-14);
        expect_near_surface(ball(), near(eye, 0.01), 1e-9);
        expect_near_surface(candlestick(), near(eye, 0.01), 1e-9);
    }
    // A man on the shore of a planet.
    const Sphere planet = {{0, 0, -6.4e6}, 6.4e6};
    const LocalDeviation from_shore = near({0.3, 0.1, 2}, 1e-3);
    expect_near_surface(planet, from_shore, 1e-8);
    EXPECT_LT(curved_facets(planet, from_shore, most).triangles.size(), 20000U);
}

/// How far along the line from the origin the farthest facet is.
double farthest_along(const CurvedFacets& facets, Vec3 origin, Vec3 direction) {
    double farthest = 0;
    for (const auto& triangle : facets.triangles) {
        const Vec3 a = facets.corners[triangle.corners[0]] - origin;
        const Vec3 b = facets.corners[triangle.corners[1]] - origin;
        const Vec3 c = facets.corners[triangle.corners[2]] - origin;
        const bool inside = dot(direction, cross(a, b)) >= 0 && dot(direction, cross(b, c)) >= 0
            && dot(direction, cross(c, a)) >= 0;
        const Vec3 normal = cross(b - a, c - a);
        if (inside && dot(direction, normal) > 0)
            farthest = std::max(farthest, dot(a, normal) / dot(direction, normal));
    }
    return farthest;
}

TEST(CurvedFacets, MissNoPlaceWhereLittleIsAskedForAround) {
    // An eye close to what is large: at a place that no rough look would find.
    RotationalShape tower;
    tower.start = {1000, 0};
    tower.contour = {line_to({1000, 3000})};
    for (int i = 0; i < 40; ++i) {
        const Vec3 out = normalized({std::cos(1 + 7.3 * i), std::sin(1 + 7.3 * i), 0});
        const Vec3 direction = normalized(out + Vec3{0, 0, std::sin(3.1 * i)});
        const Sphere planet = {{}, 1e6};
        const Vec3 on_planet = 1e6 * direction;
        const LocalDeviation from_above = near((1e6 + 2) * direction, 0.1);
        const CurvedFacets of_planet = curved_facets(planet, from_above, most);
        EXPECT_NEAR(farthest_along(of_planet, {}, direction), 1e6, from_above(on_planet)) << i;

        const Vec3 floor = {0, 0, 1500 + 1400 * std::sin(1.7 * i)};
        const LocalDeviation from_outside = near(floor + 1000.05 * out, 0.1);
        const CurvedFacets of_tower = curved_facets(tower, from_outside, most);
        EXPECT_NEAR(farthest_along(of_tower, floor, out), 1000, from_outside(floor + 1000 * out))
            << i;
    }
}

TEST(CurvedFacets, FaceTheOuterSideOfTheContour) {
    // A ring, first from the axis, then towards it.
    for (const double side : {-1.0, 1.0}) {
        RotationalShape shape;
        shape.start = {side < 0 ? 1.0 : 2.0, 5};
        shape.contour = {line_to({side < 0 ? 2.0 : 1.0, 5})};
        const CurvedFacets facets = curved_facets(shape, everywhere(0.01), most);
        EXPECT_FALSE(facets.triangles.empty());
        for (const auto& triangle : facets.triangles) {
            const auto& [a, b, c] = triangle.corners;
            const Vec3 normal =
                cross(facets.corners[b] - facets.corners[a], facets.corners[c] - facets.corners[a]);
            EXPECT_GT(side * normal.z, 0);
        }
    }
}

TEST(CurvedFacets, NameTheirPieces) {
    std::set<std::uint32_t> pieces;
    for (const auto& triangle : curved_facets(candlestick(), everywhere(0.1), most).triangles)
        pieces.insert(triangle.piece);
    EXPECT_EQ(pieces, (std::set<std::uint32_t>{0, 1, 2, 4, 5, 6}));
}

TEST(CurvedFacets, TakeFewerCornersRoundSmallerCircles) {
    // The neck and the plate: each as many as it needs.
    const CurvedFacets facets = curved_facets(candlestick(), everywhere(0.01), most);
    std::map<std::uint32_t, std::size_t> of_piece;
    for (const auto& triangle : facets.triangles)
        ++of_piece[triangle.piece];
    EXPECT_EQ(of_piece[1], 256U) << "20 (1 - cos(180 / 128)) = 0.006";
    EXPECT_EQ(of_piece[2], 128U + 16U) << "0.5 (1 - cos(180 / 16)) = 0.0096";
    EXPECT_EQ(of_piece[4], 16U + 64U) << "the cone that follows widens to 3";
}

TEST(CurvedFacets, OfShapesWithoutAreaAreNone) {
    for (const RotationalShape& shape :
         {shape_of({0, 0}, {line_to({0, 1}), line_to({0, 5})}),
          shape_of({1, 1}, {line_to({1, 1})}),
          shape_of({1, 1}, {}),
          shape_of({0, 0}, {cubic_to({0, 1}, {0, 0.2}, {0, 0.8})})}) {
        const CurvedFacets facets = curved_facets(shape, everywhere(0.01), most);
        EXPECT_TRUE(facets.triangles.empty());
    }
}

TEST(CurvedFacets, GoOnAfterAPieceOfTheAxis) {
    const RotationalShape two_cones = shape_of(
        {0, 0},
        {line_to({1, 0}), line_to({0, 1}), line_to({0, 2}), line_to({1, 2}), line_to({0, 3})});
    EXPECT_EQ(expect_closed(curved_facets(two_cones, everywhere(0.01), most)), 4);
}

TEST(CurvedFacets, MeetAgainOnOneCircle) {
    // A hollow cylinder: the last piece ends where the first one starts.
    const RotationalShape pipe =
        shape_of({2, 0}, {line_to({2, 5}), line_to({1, 5}), line_to({1, 0}), line_to({2, 0})});
    EXPECT_EQ(expect_closed(curved_facets(pipe, everywhere(0.001), most)), 0);
}

TEST(CurvedFacets, OfAnySizeAreAlike) {
    const auto scaled = [](double size) {
        RotationalShape shape;
        shape.start = {0, 0};
        shape.contour = {line_to({size, 0}), cubic_to({0, size}, {size, size}, {size, 2 * size})};
        return shape;
    };
    const std::size_t of_ball =
        curved_facets(Sphere{{}, 1}, everywhere(1e-3), most).triangles.size();
    const std::size_t of_shape = curved_facets(scaled(1), everywhere(1e-3), most).triangles.size();
    for (const double size : {1e-30, 1e-3, 1e30, 1e70}) {
        const CurvedFacets ball_facets =
            curved_facets(Sphere{{}, size}, everywhere(1e-3 * size), most);
        EXPECT_EQ(ball_facets.triangles.size(), of_ball);
        for (const Vec3& corner : ball_facets.corners)
            EXPECT_NEAR(length(corner) / size, 1, 1e-15);
        const CurvedFacets facets = curved_facets(scaled(size), everywhere(1e-3 * size), most);
        EXPECT_EQ(facets.triangles.size(), of_shape);
        EXPECT_EQ(expect_closed(facets), 2);
    }
}

TEST(CurvedFacets, StayWithinTheirNumber) {
    for (const double deviation : {0.0, 1e-12}) {
        for (const std::size_t few : {std::size_t{1000}, std::size_t{50000}}) {
            const std::size_t of_ball =
                curved_facets(Sphere{{}, 1}, everywhere(deviation), few).triangles.size();
            EXPECT_LE(of_ball, few);
            EXPECT_GE(of_ball, few / 4);
            for (const RotationalShape& shape : {torus(), candlestick()}) {
                const CurvedFacets facets = curved_facets(shape, everywhere(deviation), few);
                EXPECT_LE(facets.triangles.size(), few);
                EXPECT_GE(facets.triangles.size(), few / 32);
            }
        }
    }
    // Fewer than there can be: the fewest.
    EXPECT_EQ(curved_facets(Sphere{{}, 1}, everywhere(0), 3).triangles.size(), 32U);
    EXPECT_EQ(expect_closed(curved_facets(candlestick(), everywhere(0), 3)), 2);
}

} // namespace
} // namespace vera
