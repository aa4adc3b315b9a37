// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/foreign_borders.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

using Border = ForeignBorders::Border;
using Parts = std::vector<std::vector<DrawingPoint>>;

constexpr std::uint32_t background = 0;
constexpr std::uint32_t wall = 1;
constexpr std::uint32_t ball = 2;

TEST(ForeignBorders, LeaveOutWhatIsCloserThanTheLineReaches) {
    const ForeignBorders borders(100, 100, 1, {{{50, 0}, {50, 100}, 0, background}});
    EXPECT_EQ(
        borders.clear_parts({10, 50}, {90, 50}, 5, ball),
        (Parts{{{10, 50}, {49, 50}}, {{51, 50}, {90, 50}}}));
    EXPECT_EQ(borders.clear_parts({50.5, 10}, {50.5, 90}, 5, ball), Parts{});
    EXPECT_EQ(borders.clear_parts({52, 10}, {52, 90}, 5, ball), (Parts{{{52, 10}, {52, 90}}}));
    EXPECT_EQ(borders.clear_parts({10, 50}, {50, 50}, 5, ball), (Parts{{{10, 50}, {49, 50}}}));
}

TEST(ForeignBorders, AreRoundedAtTheirEnds) {
    const ForeignBorders borders(100, 100, 1, {{{50, 50}, {50, 50}, 0, background}});
    EXPECT_EQ(
        borders.clear_parts({10, 50}, {90, 50}, 5, ball),
        (Parts{{{10, 50}, {49, 50}}, {{51, 50}, {90, 50}}}));
    EXPECT_EQ(
        borders.clear_parts({10, 51.5}, {90, 51.5}, 5, ball), (Parts{{{10, 51.5}, {90, 51.5}}}));
}

TEST(ForeignBorders, DoNotMatterToWhatIsPaintedEarlierNorToTheirOwnThing) {
    const ForeignBorders borders(100, 100, 1, {{{50, 0}, {50, 100}, 3, wall}});
    const Parts whole = {{{10, 50}, {90, 50}}};
    EXPECT_EQ(borders.clear_parts({10, 50}, {90, 50}, 4, wall), whole);
    EXPECT_EQ(borders.clear_parts({10, 50}, {90, 50}, 3, ball), whole);
    EXPECT_EQ(borders.clear_parts({10, 50}, {90, 50}, 4, ball).size(), 2U);
}

TEST(ForeignBorders, OfNothingLeaveEverything) {
    const ForeignBorders borders(1, 1, 1, {});
    EXPECT_EQ(borders.clear_parts({0, 0}, {1, 1}, 1, wall), (Parts{{{0, 0}, {1, 1}}}));
    EXPECT_EQ(borders.clear_parts({1, 1}, {1, 1}, 1, wall), Parts{});
}

double distance(DrawingPoint point, const Border& border) {
    const double x = border.end.x - border.begin.x;
    const double y = border.end.y - border.begin.y;
    const double along = (point.x - border.begin.x) * x + (point.y - border.begin.y) * y;
    const double part = std::min(1.0, std::max(0.0, along / (x * x + y * y)));
    return std::hypot(point.x - border.begin.x - part * x, point.y - border.begin.y - part * y);
}

TEST(ForeignBorders, AreAllFound) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> x(0, 300);
    std::uniform_real_distribution<double> y(0, 200);
    std::uniform_real_distribution<double> step(-20, 20);
    std::vector<Border> all;
    for (int i = 0; i < 300; ++i) {
        const DrawingPoint begin = {x(random), y(random)};
        all.push_back({begin, {begin.x + step(random), begin.y + step(random)}, 0, background});
    }
    const ForeignBorders borders(300, 200, 1, all);
    for (int i = 0; i < 300; ++i) {
        const DrawingPoint begin = {x(random), y(random)};
        const DrawingPoint end = {x(random), y(random)};
        const Parts parts = borders.clear_parts(begin, end, 1, wall);
        for (int j = 0; j <= 100; ++j) {
            const double place = j / 100.0;
            const DrawingPoint point = {
                begin.x + place * (end.x - begin.x), begin.y + place * (end.y - begin.y)};
            double nearest = 2;
            for (const Border& border : all)
                nearest = std::min(nearest, distance(point, border));
            bool is_clear = false;
            for (const auto& part : parts)
                is_clear = is_clear || distance(point, {part[0], part[1], 0, 0}) < 1e-9;
            if (std::abs(nearest - 1) > 1e-9) {
                EXPECT_EQ(is_clear, nearest > 1) << i << ' ' << j;
            }
        }
    }
}

} // namespace
} // namespace vera
