// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/turned.h"
#include "vera/scene/contour.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

using Point = ContourPiece::Point;

std::vector<double> numbers_of(const RotationalShape& shape) {
    std::vector<double> numbers = {shape.start.r, shape.start.h};
    for (const ContourPiece& piece : shape.contour)
        numbers.insert(numbers.end(), {piece.end.r, piece.end.h});
    return numbers;
}

TEST(Turned, HasWhatTheProfileEnclosesInsideInWhicheverOrder) {
    const std::vector<Point> up = {{0, 0}, {1, 0}, {1, 50}, {0, 50}};
    const std::vector<Point> down(up.rbegin(), up.rend());
    const std::vector<double> expected = {0, 0, 1, 0, 1, 50, 0, 50};
    EXPECT_EQ(numbers_of(turned_shape(up, ProfileForm::straight)), expected);
    EXPECT_EQ(numbers_of(turned_shape(down, ProfileForm::straight)), expected);
    // A wall alone.
    EXPECT_EQ(
        numbers_of(turned_shape(std::vector<Point>{{2, 5}, {2, 1}}, ProfileForm::straight)),
        (std::vector<double>{2, 1, 2, 5}));
}

TEST(Turned, LeavesOutWhatHasNoArea) {
    const auto pieces = [](const std::vector<Point>& profile) {
        return turned_shape(profile, ProfileForm::smooth).contour.size();
    };
    EXPECT_EQ(pieces({{0, 0}, {0, 1}, {1, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 3}}), 3U);
    EXPECT_EQ(pieces({{0, 0}, {0, 1}}), 0U);
    EXPECT_EQ(pieces({{1, 1}, {1, 1}}), 0U);
    EXPECT_EQ(pieces({}), 0U);
}

// Drawn from few values: points on the axis, corners and turns back are common.
TEST(Turned, PassesSmoothlyThroughItsPointsAndNeverBeyondTheAxis) {
    std::mt19937 random(1987);
    int smooth_points = 0;
    for (int round = 0; round < 300; ++round) {
        std::vector<Point> profile;
        for (std::size_t i = 0; i < 5; ++i) {
            const double r = static_cast<double>(random() % 3);
            const double h = static_cast<double>(random() % 4);
            profile.push_back({r, h});
        }
        const RotationalShape shape = turned_shape(profile, ProfileForm::smooth);
        Point from = shape.start;
        for (std::size_t i = 0; i < shape.contour.size(); ++i) {
            const ContourPiece& piece = shape.contour[i];
            for (int step = 0; step <= 16; ++step)
                EXPECT_GE(point_at(piece, from, step / 16.0).r, 0) << round;
            if (i > 0) {
                // No corner where the point stands once, off the axis.
                const ContourPiece& before = shape.contour[i - 1];
                const Point in = {from.r - before.control[1].r, from.h - before.control[1].h};
                const Point out = {piece.control[0].r - from.r, piece.control[0].h - from.h};
                int times = 0;
                for (const Point point : profile)
                    times += point.r == from.r && point.h == from.h ? 1 : 0;
                const bool is_held =
                    piece.control[0].r == 0 || before.control[1].r == 0; // by the axis
                if (times == 1 && !is_held) {
                    EXPECT_NEAR(in.r * out.h - in.h * out.r, 0, 1e-12) << round;
                    EXPECT_GE(in.r * out.r + in.h * out.h, 0) << round;
                    ++smooth_points;
                }
            }
            from = piece.end;
        }
    }
    EXPECT_GT(smooth_points, 200);
}

TEST(Turned, HasCornersAtPointsThatAreGivenTwice) {
    const auto shape = turned_shape(
        std::vector<Point>{{0, 0}, {1, 0}, {1, 0}, {1, 2}, {1, 2}, {0, 2}}, ProfileForm::smooth);
    ASSERT_EQ(shape.contour.size(), 3U);
    // A straight wall, as there is no other point on either side of it.
    EXPECT_EQ(point_at(shape.contour[1], {1, 0}, 0.5).r, 1);
    EXPECT_NEAR(shape.contour[1].control[0].h, 2.0 / 3, 1e-12);
}

} // namespace
} // namespace vera
