// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/half_plane.h"
#include "vera/visible/seam_strips.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "visible/painted_color.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::doubled_area;
using testing::turns_about;

struct Side {
    int x, y, dx, dy;
    bool used = false;
};

/// The sides of some squares of a board that have no square beyond them, with the area on the same
/// hand.
std::vector<Side> random_sides(std::mt19937& random) {
    constexpr int size = 5;
    bool filled[size + 2][size + 2] = {};
    for (int y = 1; y <= size; ++y)
        for (int x = 1; x <= size; ++x)
            filled[y][x] = random() % 3 != 0;
    std::vector<Side> sides;
    for (int y = 1; y <= size; ++y)
        for (int x = 1; x <= size; ++x)
            for (const Side& side :
                 {Side{x, y, 1, 0}, {x + 1, y, 0, 1}, {x + 1, y + 1, -1, 0}, {x, y + 1, 0, -1}})
                if (filled[y][x] && !filled[y - side.dx][x + side.dy])
                    sides.push_back(side);
    return sides;
}

/// The squares' area as the ways round it: with holes, and with parts that touch in corners.
std::vector<BorderRing> random_board(std::mt19937& random) {
    std::vector<Side> sides = random_sides(random);
    std::vector<BorderRing> rings;
    for (Side& start : sides) {
        if (start.used)
            continue;
        BorderRing& ring = rings.emplace_back();
        for (Side* side = &start; side != nullptr;) {
            side->used = true;
            ring.push_back({static_cast<double>(side->x), static_cast<double>(side->y)});
            const int x = side->x + side->dx;
            const int y = side->y + side->dy;
            const auto next = std::ranges::find_if(sides, [&](const Side& other) {
                return !other.used && other.x == x && other.y == y;
            });
            side = next == sides.end() ? nullptr : &*next;
        }
    }
    return rings;
}

TEST(HalfPlane, CutsAreasIntoTwoThatMakeUpTheWhole) {
    std::mt19937 random(1);
    const double values[] = {-2, -1, -0.5, 0, 0.5, 1, 2};
    const auto value = [&] { return values[random() % std::size(values)]; };
    for (int round = 0; round < 3000; ++round) {
        const std::vector<BorderRing> rings = random_board(random);
        const HalfPlane half = {{value(), value()}, 4 * value()};
        const HalfPlane rest = {{-half.normal.x, -half.normal.y}, -half.reach};
        const auto inside = cut_rings(rings, half);
        const auto outside = cut_rings(rings, rest);
        if (half.normal != DrawingPoint{}) {
            EXPECT_NEAR(doubled_area(inside) + doubled_area(outside), doubled_area(rings), 1e-9)
                << "round " << round;
        }
        for (int i = 0; i < 20; ++i) {
            // Off the board's lines, and off the border for almost all.
            const DrawingPoint point = {
                1 + 0.37 * static_cast<double>(random() % 14) + 0.0123,
                1 + 0.37 * static_cast<double>(random() % 14) + 0.0321};
            const double beyond = half.normal.x * point.x + half.normal.y * point.y - half.reach;
            if (std::abs(beyond) < 1e-6)
                continue;
            ASSERT_EQ(turns_about(inside, point), beyond <= 0 ? turns_about(rings, point) : 0)
                << "round " << round << " at " << point.x << ' ' << point.y;
        }
    }
}

TEST(HalfPlane, LeavesNoBridgesBetweenPartsOfARing) {
    // A U, of which a cut leaves both arms.
    const std::vector<BorderRing> rings = {
        {{0, 0}, {5, 0}, {5, 4}, {4, 4}, {4, 1}, {1, 1}, {1, 4}, {0, 4}}};
    EXPECT_EQ(cut_rings(rings, {{0, -1}, -2}).size(), 2U);
    EXPECT_EQ(cut_rings(rings, {{0, 1}, 2}).size(), 1U);
}

TEST(HalfPlane, KeepsTheCurvesOfWhatIsLeftOfSides) {
    const BorderRing ring = {{{0, 0}, 1}, {{4, 0}, 2}, {{4, 4}, 3, true}, {{0, 4}, no_curve}};
    const auto inside = cut_rings({ring}, {{1, 0}, 2});
    ASSERT_EQ(inside.size(), 1U);
    std::vector<std::uint32_t> curves;
    for (const BorderPoint& point : inside[0])
        curves.push_back(point.curve);
    // From where side 3 comes in: the rest of it, the side without a curve, side 1, and the cut.
    EXPECT_EQ(curves, (std::vector<std::uint32_t>{3, no_curve, 1, no_curve}));
    const auto along = cut_rings({ring}, {{0, 1}, 4}); // all of it
    ASSERT_EQ(along.size(), 1U);
    EXPECT_TRUE(along[0][2].is_node);
    EXPECT_EQ(along[0][2].curve, 3U);
}

TEST(HalfPlane, CutsLinesIntoTheirParts) {
    const std::vector<PointChain> zigzag = {{{0, 0}, {2, 2}, {4, 0}, {6, 2}}, {{0, 3}, {1, 3}}};
    const std::vector<PointChain> below = {{{0, 0}, {1, 1}}, {{3, 1}, {4, 0}, {5, 1}}};
    EXPECT_EQ(cut_lines(zigzag, {{0, 1}, 1}), below);
    EXPECT_EQ(cut_lines(zigzag, {{0, 1}, 3}), zigzag);
    EXPECT_EQ(cut_lines(zigzag, {{0, 1}, 0}), std::vector<PointChain>());
}

TEST(SeamStrips, LieInTheNeighbourAndCloseToTheBorder) {
    // A quarter of a circle, and what is outside of it.
    BorderRing arc;
    for (int i = 0; i <= 40; ++i)
        arc.push_back({50 * std::sin(i * 0.039), 50 - 50 * std::cos(i * 0.039)});
    BorderRing outside = arc;
    outside.push_back({100, 50});
    outside.push_back({100, -20});
    outside.push_back({0, -20});
    const auto strips = seam_strips(arc, {outside});
    for (int i = 1; i < 40; ++i) {
        const DrawingPoint middle = {
            0.5 * (arc[static_cast<std::size_t>(i)].x + arc[static_cast<std::size_t>(i - 1)].x),
            0.5 * (arc[static_cast<std::size_t>(i)].y + arc[static_cast<std::size_t>(i - 1)].y)};
        const double size = std::hypot(middle.x, middle.y - 50);
        const auto moved = [&](double by) {
            return DrawingPoint{
                middle.x + by * middle.x / size, middle.y + by * (middle.y - 50) / size};
        };
        EXPECT_NE(turns_about(strips, moved(0.05)), 0) << i;
        EXPECT_NE(turns_about(strips, moved(0.95)), 0) << i;
        EXPECT_EQ(turns_about(strips, moved(1.6)), 0) << i;
        EXPECT_EQ(turns_about(strips, moved(-0.05)), 0) << i;
    }
}

TEST(SeamStrips, ReachNoFartherThanAThinNeighbour) {
    const std::vector<BorderRing> thin = {{{0, 0}, {10, 0}, {10, 0.3}, {0, 0.3}}};
    EXPECT_EQ(doubled_area(seam_strips(BorderRing{{0, 0}, {10, 0}}, thin)), doubled_area(thin));
    const std::vector<BorderRing> other = {{{0, 5}, {10, 5}, {10, 6}, {0, 6}}};
    EXPECT_TRUE(seam_strips(BorderRing{{0, 0}, {10, 0}}, other).empty());
    EXPECT_TRUE(seam_strips(BorderRing{{0, 0}, {0, 0}}, thin).empty());
}

TEST(SeamStrips, CoverSomethingNarrowThatTheBorderGoesAllTheWayRound) {
    const BorderRing wedge = {{0, 0}, {10, 0.1}, {10, 0.4}};
    for (std::size_t first = 0; first < wedge.size(); ++first) {
        BorderRing border;
        for (std::size_t i = 0; i <= wedge.size(); ++i)
            border.push_back(wedge[(first + wedge.size() - i % wedge.size()) % wedge.size()]);
        const auto strips = seam_strips(border, {wedge});
        for (const double x : {1.5, 5.0, 9.5})
            EXPECT_NE(turns_about(strips, {x, 0.025 * x}), 0) << first << ' ' << x;
    }
}

} // namespace
} // namespace vera
