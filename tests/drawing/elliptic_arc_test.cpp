// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/elliptic_arc.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr double degrees_per_radian = 180 / std::numbers::pi;

DrawingEllipse random_ellipse(std::mt19937_64& random) {
    const double sizes[] = {0.01, 1, 3, 50, 1000};
    const auto one_of = [&] { return sizes[random() % 5]; };
    const double a = one_of();
    const double b = std::min(a, one_of());
    const double turn = static_cast<double>(random() % 24) * 15 / degrees_per_radian;
    return {
        {one_of(), -one_of()},
        {a * std::cos(turn), a * std::sin(turn)},
        {-b * std::sin(turn), b * std::cos(turn)}};
}

TEST(EllipticArc, TellsTheAngleOfADirectionAsTheArcTangentDoes) {
    const double values[] = {0, 1e-300, 1e-9, 0.1, 1, 1 + 1e-9, 7, 1e9};
    for (const double x : values)
        for (const double y : values)
            for (const auto& [i, j] : {std::pair{1, 1}, {1, -1}, {-1, 1}, {-1, -1}})
                if (x > 0 || y > 0) {
                    EXPECT_NEAR(
                        direction_degrees({i * x, j * y}),
                        std::atan2(j * y + 0.0, i * x) * degrees_per_radian,
                        1e-12)
                        << i * x << ' ' << j * y;
                }
    EXPECT_EQ(direction_degrees({0, 0}), 0);
    EXPECT_EQ(direction_degrees({-3, 0}), 180);
}

TEST(EllipticArc, FindsThePointOfTheEllipseThatIsNearest) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 2000; ++i) {
        const DrawingEllipse ellipse = random_ellipse(random);
        const double a = distance(ellipse.major, {});
        // On it, off it by less than it is thick, anywhere, and at its center.
        DrawingPoint point = point_at(ellipse, static_cast<double>(random() % 360));
        const double off[] = {0, 1e-3 * a, a, 3 * a};
        point.x += off[random() % 4];
        point.y -= off[random() % 4];
        if (i % 50 == 0)
            point = ellipse.center;
        double least = distance(point, point_at(ellipse, 0));
        for (double angle = 0.25; angle < 360; angle += 0.25)
            least = std::min(least, distance(point, point_at(ellipse, angle)));
        // No sampled point is nearer, but by what the method leaves.
        EXPECT_LE(
            distance(point, point_at(ellipse, nearest_degrees(ellipse, point))),
            least + 1e-3 * a + 1e-9)
            << i;
    }
}

TEST(EllipticArc, FindsBackThePointsOfTheEllipseItself) {
    std::mt19937_64 random(2);
    for (int i = 0; i < 1000; ++i) {
        const DrawingEllipse ellipse = random_ellipse(random);
        const DrawingPoint point = point_at(ellipse, static_cast<double>(random() % 720) / 2);
        EXPECT_LE(
            distance(point, point_at(ellipse, nearest_degrees(ellipse, point))),
            1e-9 * distance(ellipse.major, {}) + 1e-9)
            << i;
    }
}

TEST(EllipticArc, BezierCurvesKeepTheirBound) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 1000; ++i) {
        DrawingArc arc;
        arc.ellipse = random_ellipse(random);
        arc.begin_degrees = static_cast<double>(random() % 360);
        arc.end_degrees = arc.begin_degrees + static_cast<double>(random() % 361) * (i % 2 * 2 - 1);
        const double errors[] = {1e-6, 1e-3, 0.5};
        const double error = errors[random() % 3];
        const int parts = bezier_parts(arc, error);
        const double step = (arc.end_degrees - arc.begin_degrees) / parts;
        EXPECT_LE(std::abs(step), 90.0001);
        const double begin = arc.begin_degrees + step * static_cast<double>(i % 4 % parts);
        const DrawingPoint first = point_at(arc.ellipse, begin);
        const DrawingPoint last = point_at(arc.ellipse, begin + step);
        const auto [second, third] = bezier_controls(arc.ellipse, begin, begin + step);
        for (double t = 0; t <= 1; t += 0.125) {
            const double s = 1 - t;
            const auto mixed = [&](double a, double b, double c, double d) {
                return s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d;
            };
            const DrawingPoint at = {
                mixed(first.x, second.x, third.x, last.x),
                mixed(first.y, second.y, third.y, last.y)};
            EXPECT_LE(
                distance(at, point_at(arc.ellipse, nearest_degrees(arc.ellipse, at))), error + 1e-9)
                << i;
        }
    }
}

} // namespace
} // namespace vera
