// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/polygon_triangles.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

struct Split {
    OutlineKind kind = OutlineKind::tangled;
    std::vector<CornerTriple> triangles;
};

Split split(const std::vector<Vec3>& corners) {
    Split result;
    result.kind = split_polygon(corners, result.triangles);
    return result;
}

Vec3 doubled_area_vector(const std::vector<Vec3>& corners, const CornerTriple& triangle) {
    return cross(
        corners[triangle[1]] - corners[triangle[0]], corners[triangle[2]] - corners[triangle[0]]);
}

/// The triangles face the polygon's way, and their areas add up to its own: so they cover it once.
void expect_covered(const std::vector<Vec3>& corners, const Split& result) {
    const Vec3 whole = vera::doubled_area_vector(corners);
    double sum = 0;
    for (const CornerTriple& triangle : result.triangles) {
        const Vec3 area = doubled_area_vector(corners, triangle);
        ASSERT_GT(dot(area, whole), 0);
        sum += length(area);
    }
    ASSERT_NEAR(sum, length(whole), 1e-9 * length(whole));
    ASSERT_LE(result.triangles.size(), corners.size() - 2);
}

TEST(SplitPolygon, FansAConvexPolygonRoundItsFirstCorner) {
    const Split pentagon = split({{0, 0, 1}, {2, 0, 1}, {3, 2, 1}, {1, 3, 1}, {-1, 2, 1}});
    EXPECT_EQ(pentagon.kind, OutlineKind::convex);
    EXPECT_EQ(pentagon.triangles, (std::vector<CornerTriple>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
    const Split square = split({{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}});
    EXPECT_EQ(square.kind, OutlineKind::convex);
    EXPECT_EQ(square.triangles, (std::vector<CornerTriple>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(SplitPolygon, FansAQuadrangleWhoseCornersAllFaceItsWay) {
    std::mt19937 random(1988);
    const auto pick = [&] { return static_cast<double>(random() % 4) / 3; };
    int fans = 0;
    for (int round = 0; round < 20'000; ++round) {
        std::vector<Vec3> corners;
        for (int i = 0; i < 4; ++i)
            corners.push_back({pick(), pick(), pick() / 8});
        const Vec3 normal = cross(corners[2] - corners[0], corners[3] - corners[1]);
        const auto faces_up = [&](const CornerTriple& triangle) {
            return dot(doubled_area_vector(corners, triangle), normal) > 0;
        };
        if (!faces_up({3, 0, 1}) || !faces_up({0, 1, 2}) || !faces_up({1, 2, 3})
            || !faces_up({2, 3, 0}))
            continue;
        ++fans;
        const Split result = split(corners);
        ASSERT_EQ(result.kind, OutlineKind::convex);
        ASSERT_EQ(result.triangles, (std::vector<CornerTriple>{{0, 1, 2}, {0, 2, 3}}));
    }
    EXPECT_GT(fans, 1'000);
}

TEST(SplitPolygon, SplitsAQuadrangleAtItsReflexCornerWhicheverThatIs) {
    const std::vector<Vec3> dart = {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}};
    for (std::size_t shift = 0; shift < 4; ++shift)
        for (const bool from_behind : {false, true}) {
            std::vector<Vec3> corners = dart;
            std::rotate(
                corners.begin(),
                corners.begin() + static_cast<std::ptrdiff_t>(shift),
                corners.end());
            if (from_behind)
                std::reverse(corners.begin(), corners.end());
            const Split result = split(corners);
            EXPECT_EQ(result.kind, OutlineKind::simple);
            EXPECT_EQ(result.triangles.size(), 2U);
            expect_covered(corners, result);
        }
}

TEST(SplitPolygon, KeepsCornersOnStraightSidesInTheTriangles) {
    // Else the neighbour along such a side, which has that corner, would leave a crack.
    const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
    const Split result = split(corners);
    EXPECT_EQ(result.kind, OutlineKind::convex);
    EXPECT_EQ(result.triangles.size(), 3U);
    expect_covered(corners, result);
}

TEST(SplitPolygon, SplitsAHoleThatABridgeJoinsToTheOutline) {
    const std::vector<Vec3> corners = {
        {0, 0, 0},
        {4, 0, 0},
        {4, 4, 0},
        {0, 4, 0},
        {0, 0, 0},
        {1, 1, 0},
        {1, 3, 0},
        {3, 3, 0},
        {3, 1, 0},
        {1, 1, 0}};
    const Split result = split(corners);
    EXPECT_EQ(result.kind, OutlineKind::simple);
    expect_covered(corners, result);
}

TEST(SplitPolygon, CallsABowTieTangledAndStillGivesTriangles) {
    const Split result = split({{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 1, 0}});
    EXPECT_EQ(result.kind, OutlineKind::tangled);
    EXPECT_FALSE(result.triangles.empty());
}

TEST(SplitPolygon, CallsAPentagramTangled) {
    std::vector<Vec3> corners;
    for (const double turn : {0.0, 0.8, 1.6, 2.4, 3.2})
        corners.push_back({std::cos(M_PI * turn), std::sin(M_PI * turn), 0});
    EXPECT_EQ(split(corners).kind, OutlineKind::tangled);
}

TEST(SplitPolygon, GivesTheSameTrianglesForAPolygonOfAnySize) {
    const std::vector<Vec3> corners = {
        {0, 0, 0}, {4, 0, 1}, {4, 4, 1}, {2, 1, 0.5}, {0, 4, 0}, {1, 2, 0.25}};
    const Split expected = split(corners);
    for (const int exponent : {-1000, -540, -20, 20, 500, 1000}) {
        std::vector<Vec3> scaled;
        for (const Vec3& corner : corners)
            scaled.push_back(
                {std::ldexp(corner.x, exponent),
                 std::ldexp(corner.y, exponent),
                 std::ldexp(corner.z, exponent)});
        EXPECT_EQ(split(scaled).triangles, expected.triangles) << exponent;
    }
}

/// A polygon round the origin: with a radius for each angle it is simple.
std::vector<Vec3> star(std::mt19937& random, std::size_t corner_count, Vec3 across, Vec3 up) {
    std::vector<Vec3> corners;
    for (std::size_t i = 0; i < corner_count; ++i) {
        // Few radii, so that corners on one line are common.
        const double radius = 1 + static_cast<double>(random() % 3);
        const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(corner_count);
        corners.push_back(radius * std::cos(angle) * across + radius * std::sin(angle) * up);
    }
    return corners;
}

TEST(SplitPolygon, CoversRandomSimplePolygonsOnce) {
    std::mt19937 random(1988);
    const Vec3 ways[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 2, 3}, {-1, 1, 0.5}};
    for (int round = 0; round < 3000; ++round) {
        const Vec3 across = ways[random() % 5];
        Vec3 up = ways[random() % 5];
        if (cross(across, up) == Vec3{})
            up = {across.z, across.x, -across.y};
        const std::vector<Vec3> corners = star(random, 5 + random() % 20, across, up);
        const Split result = split(corners);
        ASSERT_NE(result.kind, OutlineKind::tangled) << "round " << round;
        expect_covered(corners, result);
    }
}

/// Corners of a comb: teeth that reach far and lie close together.
std::vector<Vec3> comb(std::size_t teeth) {
    std::vector<Vec3> corners;
    for (std::size_t i = 0; i < teeth; ++i) {
        const auto x = static_cast<double>(i);
        corners.push_back({x, 1, 0});
        corners.push_back({x + 0.5, 100, 0});
    }
    const auto last = static_cast<double>(teeth);
    corners.push_back({last, 1, 0});
    corners.push_back({last, 0, 0});
    corners.push_back({0, 0, 0});
    return corners;
}

TEST(SplitPolygon, TakesTenThousandCornersInItsStride) {
    std::vector<Vec3> corners = comb(5000);
    expect_covered(corners, split(corners));
    std::mt19937 random(1988);
    corners = star(random, 10'000, {1, 0, 0}, {0, 1, 0});
    EXPECT_NE(split(corners).kind, OutlineKind::tangled);
}

/// All corners between the teeth lie on one line, and what is left below them becomes a fan.
TEST(SplitPolygon, CoversACombOfManyTeethOnce) {
    std::vector<Vec3> corners;
    constexpr int teeth = 20'000;
    for (int i = 0; i < teeth; ++i) {
        const double x = 2.0 * i;
        corners.push_back({x, 0, 0});
        corners.push_back({x, 4e4, 0});
        corners.push_back({x + 1, 4e4, 0});
        corners.push_back({x + 1, 0, 0});
    }
    corners.push_back({2.0 * teeth, 0, 0});
    corners.push_back({2.0 * teeth, -1, 0});
    corners.push_back({0, -1, 0});
    const Split result = split(corners);
    ASSERT_EQ(result.kind, OutlineKind::simple);
    expect_covered(corners, result);
}

/// A spike is as long as the way on which it goes in and out: each corner is its tip when those
/// behind it are gone. Going round for each of them takes minutes.
TEST(SplitPolygon, DropsASpikeThatWindsASpiralInItsStride) {
    std::vector<Vec3> corners;
    constexpr int turns = 50'000;
    Vec3 at;
    for (int i = 0; i < turns; ++i) {
        corners.push_back(at);
        const double length = 1.0 + i / 2;
        const double way = i % 4 < 2 ? length : -length;
        at = at + (i % 2 == 0 ? Vec3{way, 0, 0} : Vec3{0, way, 0});
    }
    for (std::size_t i = corners.size() - 1; i > 0; --i)
        corners.push_back(corners[i - 1]);
    const std::vector<Vec3> triangle = {{0, 0, 0}, {-1e6, -1e6, 0}, {1e6, -1e6, 0}};
    corners.insert(corners.end(), triangle.begin(), triangle.end());
    const Split result = split(corners);
    EXPECT_EQ(result.kind, OutlineKind::tangled);
    EXPECT_LT(result.triangles.size(), 100U);
}

TEST(SplitPolygon, EndsSoonWhateverTheCorners) {
    std::mt19937 random(1988);
    std::vector<Vec3> corners;
    for (int i = 0; i < 20'000; ++i)
        corners.push_back(
            {static_cast<double>(random() % 1000), static_cast<double>(random() % 1000), 0});
    EXPECT_EQ(split(corners).kind, OutlineKind::tangled);
    EXPECT_LE(split(corners).triangles.size(), corners.size() - 2);
}

TEST(SplitPolygon, LeavesNothingOfALine) {
    EXPECT_TRUE(split({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}).kind == OutlineKind::tangled);
}

} // namespace
} // namespace vera
