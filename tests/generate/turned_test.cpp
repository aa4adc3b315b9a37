// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/turned.h"
#include "vera/scene/contour.h"

#include <algorithm>
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

std::vector<Point> random_profile(std::mt19937& random) {
    std::vector<Point> profile;
    for (std::size_t i = 0; i < 5; ++i) {
        const auto r = static_cast<double>(random() % 3);
        const auto h = static_cast<double>(random() % 4);
        profile.push_back({r, h});
    }
    return profile;
}

void expect_no_corner(const ContourPiece& before, const ContourPiece& piece, int round) {
    const Point at = before.end;
    const Point in = {at.r - before.control[1].r, at.h - before.control[1].h};
    const Point out = {piece.control[0].r - at.r, piece.control[0].h - at.h};
    EXPECT_NEAR(in.r * out.h - in.h * out.r, 0, 1e-12) << round;
    EXPECT_GE(in.r * out.r + in.h * out.h, 0) << round;
}

// Drawn from few values: points on the axis, corners and turns back are common.
TEST(Turned, PassesSmoothlyThroughItsPoints) {
    std::mt19937 random(1987);
    int smooth_points = 0;
    for (int round = 0; round < 300; ++round) {
        const std::vector<Point> profile = random_profile(random);
        const RotationalShape shape = turned_shape(profile, ProfileForm::smooth);
        for (std::size_t i = 1; i < shape.contour.size(); ++i) {
            const ContourPiece& before = shape.contour[i - 1];
            const ContourPiece& piece = shape.contour[i];
            const bool is_held_by_axis = piece.control[0].r == 0 || before.control[1].r == 0;
            if (std::count(profile.begin(), profile.end(), before.end) > 1 || is_held_by_axis)
                continue;
            expect_no_corner(before, piece, round);
            ++smooth_points;
        }
    }
    EXPECT_GT(smooth_points, 200);
}

TEST(Turned, NeverCrossesTheAxis) {
    std::mt19937 random(1989);
    for (int round = 0; round < 300; ++round) {
        const RotationalShape shape = turned_shape(random_profile(random), ProfileForm::smooth);
        Point from = shape.start;
        for (const ContourPiece& piece : shape.contour) {
            for (int step = 0; step <= 16; ++step)
                EXPECT_GE(point_at(piece, from, step / 16.0).r, 0) << round;
            from = piece.end;
        }
    }
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
