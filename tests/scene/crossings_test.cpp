// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <random>

#include "scene/make_scene.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using test::add;
using test::crossings;

constexpr double infinity = std::numeric_limits<double>::infinity();

RotationalShape cylinder() {
    RotationalShape shape;
    shape.start = {0, 0};
    for (const ContourPiece::Point end :
         {ContourPiece::Point{1, 0}, ContourPiece::Point{1, 50}, ContourPiece::Point{0, 50}}) {
        ContourPiece piece;
        piece.end = end;
        shape.contour.push_back(piece);
    }
    return shape;
}

TEST(Crossings, OfASphereAreBothReported) {
    Geometry geometry;
    add(geometry, Sphere{{0, 0, 10}, 2});
    EXPECT_EQ(crossings(geometry, {{}, {0, 0, 1}}), (std::vector<test::Crossing>{{8, 0}, {12, 0}}));
    EXPECT_EQ(crossings(geometry, {{}, {0, 0, 2}}), (std::vector<test::Crossing>{{4, 0}, {6, 0}}));
    EXPECT_TRUE(crossings(geometry, {{}, {0, 0, -1}}).empty());
    EXPECT_EQ(crossings(geometry, {{}, {0, 0, -1}, -infinity}).size(), 2U);
    EXPECT_EQ(crossings(geometry, {{}, {0, 0, 1}, 0, 9}).size(), 1U);
}

TEST(Crossings, OfARayThatStartsOnASphereLeaveTheStartOut) {
    Geometry geometry;
    add(geometry, Sphere{{0, 0, 0}, 1});
    for (const std::uint32_t start : {0U, no_piece}) {
        const auto inwards = crossings(geometry, {{0, 0, -1}, {0, 0, 1}}, 0, start);
        EXPECT_EQ(inwards, (std::vector<test::Crossing>{{2, 0}}));
        EXPECT_TRUE(crossings(geometry, {{0, 0, -1}, {0, 0, -1}}, 0, start).empty());
        EXPECT_TRUE(crossings(geometry, {{0, 0, -1}, {1, 0, 0}}, 0, start).empty());
    }
}

TEST(Crossings, OfACappedCylinderComeInPairs) {
    Geometry geometry;
    add(geometry, cylinder());
    EXPECT_EQ(crossings(geometry, {{-2, 0, 51}, {1, 0, -1}}).size(), 2U) << "through the rim";
    EXPECT_EQ(
        crossings(geometry, {{-5, 0, 25}, {1, 0, 0}}),
        (std::vector<test::Crossing>{{4, 1}, {6, 1}}));
    EXPECT_EQ(
        crossings(geometry, {{0.5, 0, -5}, {0, 0, 1}}),
        (std::vector<test::Crossing>{{5, 0}, {55, 2}}));
    EXPECT_EQ(
        crossings(geometry, {{-1, 0, 25}, {1, 0, 0}}, 0, 1), (std::vector<test::Crossing>{{2, 1}}));
}

TEST(Crossings, OfPlaneFacesIncludeTheirBoundary) {
    Geometry geometry;
    add(geometry, Triangle{{Vec3{0, 0, 1}, Vec3{1, 0, 1}, Vec3{0, 1, 1}}});
    test::add_polygon(geometry, {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}});
    for (const Vec3 origin : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0.5, 0, 0}, Vec3{0.25, 0.25, 0}})
        for (const std::uint32_t item : {0U, 1U})
            EXPECT_EQ(
                crossings(geometry, {origin, {0, 0, 1}}, item),
                (std::vector<test::Crossing>{{1, 0}}));
    EXPECT_TRUE(crossings(geometry, {{-0.1, 0, 0}, {0, 0, 1}}, 1).empty());
    EXPECT_TRUE(crossings(geometry, {{0.25, 0.25, 1}, {0, 0, 1}}, 0).empty());
    EXPECT_TRUE(crossings(geometry, {{0.25, 0.25, 1}, {0, 0, 1}}, 1).empty());
    EXPECT_TRUE(crossings(geometry, {{-1, 0.25, 1}, {1, 0, 0}}, 1).empty());
}

} // namespace
} // namespace vera
