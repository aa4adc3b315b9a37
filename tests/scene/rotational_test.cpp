// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/surface.h"

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "scene/contour_pieces.h"
#include "scene/make_scene.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using test::crossings;
using test::cubic_to;
using test::line_to;
using test::quarter_to;
using Point = ContourPiece::Point;

constexpr double infinity = std::numeric_limits<double>::infinity();

RotationalShape ball() {
    RotationalShape shape;
    shape.start = {0, -1};
    shape.contour = {quarter_to({1, 0}, {1, -1}), quarter_to({0, 1}, {1, 1})};
    return shape;
}

/// Radii 2 and 1/2.
RotationalShape torus() {
    RotationalShape shape;
    shape.start = {2.5, 0};
    shape.contour = {
        quarter_to({2, 0.5}, {2.5, 0.5}),
        quarter_to({1.5, 0}, {1.5, 0.5}),
        quarter_to({2, -0.5}, {1.5, -0.5}),
        quarter_to({2.5, 0}, {2.5, -0.5})};
    return shape;
}

RotationalShape capped_cylinder() {
    RotationalShape shape;
    shape.contour = {line_to({1, 0}), line_to({1, 2}), line_to({0, 2})};
    return shape;
}

/// Rings, cones of both kinds, a double tip on the axis, and curves with inflections.
RotationalShape pawn() {
    RotationalShape shape;
    shape.start = {0, -2};
    shape.contour = {
        line_to({2, -2}),
        line_to({1, -1}),
        cubic_to({1, 1}, {-0.25, -0.5}, {2.5, 0.5}),
        line_to({0, 1}),
        line_to({1, 2}),
        quarter_to({0, 3}, {1, 3})};
    return shape;
}

class FewValues {
public:
    explicit FewValues(unsigned seed)
        : random_(seed) {}

    double coordinate() {
        constexpr double values[] = {-3, -2, -1, -0.5, 0, 0, 0, 0.1, 0.5, 1, 1.5, 2, 2.5};
        return values[random_() % std::size(values)];
    }

    Vec3 point() { return {coordinate(), coordinate(), coordinate()}; }

    Vec3 direction() {
        const Vec3 few = point();
        return few == Vec3{} ? Vec3{0, 0, 1} : few;
    }

    double uniform() { return std::uniform_real_distribution<double>(-1, 1)(random_); }

    Vec3 anywhere() { return {uniform(), uniform(), uniform()}; }

private:
    std::mt19937 random_;
};

Ray whole_line(Vec3 origin, Vec3 direction) {
    return {origin, direction, -infinity};
}

/// Compares the number of crossings before points along the line with what tells whether a point
/// is inside. `inside` gives a value above 0 inside, below 0 outside, near 0 near the surface.
void expect_crossings_at_changes(
    const RotationalShape& shape,
    const std::function<double(Vec3)>& inside,
    unsigned seed,
    int rounds = 4000) {
    Geometry geometry;
    test::add(geometry, shape);
    FewValues few(seed);
    for (int round = 0; round < rounds; ++round) {
        const bool degenerate = round % 2 == 0;
        const Ray ray = degenerate ? whole_line(few.point(), few.direction())
                                   : whole_line(3 * few.anywhere(), few.anywhere());
        const auto found = crossings(geometry, ray);
        ASSERT_EQ(found.size() % 2, 0U) << "round " << round;
        for (const auto& crossing : found)
            ASSERT_NEAR(inside(point_at(ray, crossing.t)), 0, 1e-9) << "round " << round;
        for (int i = -100; i <= 100; ++i) {
            const double t = 0.0731 * i / length(ray.direction);
            const double here = inside(point_at(ray, t));
            if (std::abs(here) < 1e-6)
                continue;
            const auto before = std::count_if(
                found.begin(), found.end(), [&](const auto& crossing) { return crossing.t < t; });
            ASSERT_EQ(before % 2 == 1, here > 0) << "round " << round << " t " << t;
        }
    }
}

TEST(CurvedContours, AgreeWithTheSphere) {
    expect_crossings_at_changes(
        ball(), [](Vec3 p) { return 1 - dot(p, p); }, 1);
}

TEST(CurvedContours, AgreeWithTheTorus) {
    const auto inside = [](Vec3 p) {
        const double off = std::sqrt(p.x * p.x + p.y * p.y) - 2;
        return 0.25 - off * off - p.z * p.z;
    };
    expect_crossings_at_changes(torus(), inside, 2);
}

TEST(CurvedContours, AgreeWithAPolygonThatComesNearThem) {
    const RotationalShape shape = pawn();
    std::vector<Point> corners = {shape.start};
    for (const ContourPiece& piece : shape.contour) {
        const Point from = corners.back();
        for (int i = 1; i <= 200; ++i) {
            // Written out anew: the polynomials themselves, not the library's evaluation.
            const double v = i / 200.0;
            const double u = 1 - v;
            const auto mean = [&](double a, double b, double c, double d) {
                if (piece.kind == ContourPiece::Kind::line)
                    return u * a + v * d;
                if (piece.kind == ContourPiece::Kind::cubic)
                    return u * u * u * a + 3 * u * u * v * b + 3 * u * v * v * c + v * v * v * d;
                const double w = 2 * u * v * piece.weight;
                return (u * u * a + w * b + v * v * d) / (u * u + w + v * v);
            };
            corners.push_back(
                {mean(from.r, piece.control[0].r, piece.control[1].r, piece.end.r),
                 mean(from.h, piece.control[0].h, piece.control[1].h, piece.end.h)});
        }
    }
    const auto inside = [&](Vec3 p) {
        const double r = std::sqrt(p.x * p.x + p.y * p.y);
        double nearest = infinity;
        bool within = false;
        for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
            const Point a = corners[i];
            const Point b = corners[i + 1];
            const double dr = b.r - a.r;
            const double dh = b.h - a.h;
            const double v =
                std::clamp(((r - a.r) * dr + (p.z - a.h) * dh) / (dr * dr + dh * dh), 0.0, 1.0);
            nearest = std::min(nearest, std::hypot(a.r + v * dr - r, a.h + v * dh - p.z));
            if ((a.h <= p.z) != (b.h <= p.z) && a.r + (p.z - a.h) / dh * dr > r)
                within = !within;
        }
        // The polygon lies within 1e-4 of the curves.
        nearest = nearest < 1e-4 ? 0 : nearest;
        return within ? nearest : -nearest;
    };
    expect_crossings_at_changes(shape, inside, 3, 60);
}

TEST(CurvedContours, HaveTheSphereCrossings) {
    Geometry geometry;
    test::add(geometry, ball());
    test::add(geometry, Sphere{{0, 0, 0}, 1});
    FewValues few(4);
    for (int round = 0; round < 20000; ++round) {
        const Ray ray = whole_line(few.anywhere(), few.anywhere());
        const auto expected = crossings(geometry, ray, 1);
        const auto found = crossings(geometry, ray, 0);
        if (expected.size() == 2 && expected[1].t - expected[0].t < 1e-6)
            continue;
        ASSERT_EQ(found.size(), expected.size()) << "round " << round;
        for (std::size_t i = 0; i < found.size(); ++i)
            ASSERT_NEAR(found[i].t, expected[i].t, 1e-9) << "round " << round;
    }
}

TEST(ClosedRotationalShapes, AreCrossedInPairsThroughTheirEdgesAndTips) {
    FewValues few(5);
    for (const RotationalShape& plain : {capped_cylinder(), torus(), pawn(), ball()})
        for (int round = 0; round < 8000; ++round) {
            RotationalShape shape = plain;
            if (round % 2 == 1) {
                shape.axis = normalized(few.direction());
                shape.base = few.point();
            }
            Geometry geometry;
            test::add(geometry, shape);
            // Towards a circle in which two pieces meet.
            const auto& piece =
                shape.contour[static_cast<std::size_t>(round) % shape.contour.size()];
            const Vec3 across = normalized(cross(shape.axis, few.direction()));
            const Vec3 target = shape.base + piece.end.h * shape.axis + piece.end.r * across;
            const Vec3 origin = few.point();
            if (origin == target)
                continue;
            const auto found = crossings(geometry, whole_line(origin, target - origin));
            ASSERT_EQ(found.size() % 2, 0U) << "round " << round;
            const Ray few_valued = whole_line(few.point(), few.direction());
            ASSERT_EQ(crossings(geometry, few_valued).size() % 2, 0U) << "round " << round;
        }
}

/// Whether the point lies where two pieces meet, and so starts from both.
bool on_edge(const RotationalShape& shape, std::uint32_t piece, Vec3 point) {
    const double r = std::sqrt(point.x * point.x + point.y * point.y);
    const Point from = piece == 0 ? shape.start : shape.contour[piece - 1].end;
    const Point to = shape.contour[piece].end;
    return std::hypot(r - from.r, point.z - from.h) < 1e-7
        || std::hypot(r - to.r, point.z - to.h) < 1e-7;
}

TEST(RaysFromARotationalShape, MeetItAsOftenAsTheirSideSays) {
    FewValues few(6);
    for (const RotationalShape& shape : {capped_cylinder(), torus(), ball(), pawn()}) {
        Scene scene;
        test::add(scene.geometry, shape);
        number_primitives(scene);
        for (int round = 0; round < 4000; ++round) {
            const Ray ray = round % 2 == 0 ? whole_line(few.point(), few.direction())
                                           : whole_line(few.anywhere(), few.anywhere());
            for (const auto& crossing : crossings(scene.geometry, ray)) {
                const SurfacePoint at = surface_at(scene, ray, {crossing.t, {0, crossing.piece}});
                if (on_edge(shape, crossing.piece, at.point))
                    continue;
                Ray next;
                next.origin = at.point;
                next.origin_error = at.point_error;
                // Every fourth ray leaves at a small or very small angle.
                const double flatness[] = {1, 1, 1, std::ldexp(1.0, -(round % 20))};
                const Vec3 anyhow = few.anywhere();
                const double rise = dot(anyhow, at.geometric_normal);
                next.direction = anyhow + (flatness[round % 4] - 1) * rise * at.geometric_normal;
                if (std::abs(dot(next.direction, at.geometric_normal)) < 1e-6)
                    continue;
                const bool inwards = dot(next.direction, at.geometric_normal) < 0;
                const auto found = crossings(scene.geometry, next, 0, crossing.piece);
                ASSERT_EQ(found.size() % 2, inwards ? 1U : 0U)
                    << "round " << round << " piece " << crossing.piece;
            }
        }
    }
}

TEST(RotationalShapes, ScaleExactlyWithPowersOfTwo) {
    FewValues few(7);
    for (int round = 0; round < 2000; ++round) {
        RotationalShape shape = round % 2 == 0 ? pawn() : torus();
        shape.base = few.point();
        Geometry geometry;
        test::add(geometry, shape);
        const double scale = round % 4 < 2 ? 0x1p20 : 0x1p-20;
        RotationalShape scaled = shape;
        const auto grow = [&](Point& p) { p = {scale * p.r, scale * p.h}; };
        scaled.base = scale * shape.base;
        grow(scaled.start);
        for (ContourPiece& piece : scaled.contour) {
            grow(piece.end);
            grow(piece.control[0]);
            grow(piece.control[1]);
        }
        Geometry scaled_geometry;
        test::add(scaled_geometry, scaled);
        const Vec3 origin = few.anywhere();
        const Vec3 direction = few.direction();
        const auto found = crossings(geometry, {origin, direction});
        const auto found_scaled = crossings(scaled_geometry, {scale * origin, direction});
        ASSERT_EQ(found.size(), found_scaled.size());
        for (std::size_t i = 0; i < found.size(); ++i)
            ASSERT_EQ(scale * found[i].t, found_scaled[i].t);
    }
}

} // namespace
} // namespace vera
