// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "formats/read_text.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {

namespace {

using testing::SizeIs;

RotationalShape shape_of(const std::string& contour) {
    return read_text(within_scene("RS 0 0 0 V 0 0 1 " + contour))
        .scene.geometry.rotational_shapes.at(0);
}

ContourPiece::Point point_at(ContourPiece::Point start, const ContourPiece& piece, double t) {
    const double a = (1 - t) * (1 - t);
    const double b = 2 * t * (1 - t) * piece.weight;
    const double c = t * t;
    const double sum = a + b + c;
    return {
        (a * start.r + b * piece.control[0].r + c * piece.end.r) / sum,
        (a * start.h + b * piece.control[0].h + c * piece.end.h) / sum};
}

TEST(ContourReader, MakesArcsOfPiecesThatStayOnTheCircle) {
    struct Arc {
        const char* contour;
        std::size_t pieces;
    };

    // About (5, 0), radius 1, both ways: 90, 180, 270 and almost 360 degrees.
    const Arc arcs[] = {
        {"AN 6 0 KR 5.6 0.8 5 1", 1},
        {"AN 5 1 KR 5.6 0.8 6 0", 1},
        {"AN 6 0 KR 5 1 4 0", 2},
        {"AN 6 0 KR 5 -1 4 0", 2},
        {"AN 6 0 KR 5 1 5 -1", 4},
        {"AN 5 -1 KR 4 0 6 0", 4},
        {"AN 6 0 KR 4 0 5.96 -0.28", 4},
        {"AN 5.96 -0.28 KR 4 0 6 0", 4}};
    for (const Arc& arc : arcs) {
        const RotationalShape shape = shape_of(arc.contour);
        EXPECT_THAT(shape.contour, SizeIs(arc.pieces)) << arc.contour;
        ContourPiece::Point start = shape.start;
        for (const ContourPiece& piece : shape.contour) {
            EXPECT_EQ(piece.kind, ContourPiece::Kind::conic);
            EXPECT_GE(piece.weight, 0.49);
            for (const double t : {0.0, 0.1, 0.5, 0.8, 1.0}) {
                const auto [r, h] = point_at(start, piece, t);
                EXPECT_NEAR(std::hypot(r - 5, h), 1, 1e-14) << arc.contour;
            }
            start = piece.end;
        }
    }
}

TEST(ContourReader, GoesThroughTheMiddlePointOfAnArc) {
    // The same ends, once over the top and once below.
    const RotationalShape top = shape_of("AN 6 0 KR 5 1 4 0");
    const RotationalShape below = shape_of("AN 6 0 KR 5 -1 4 0");
    EXPECT_NEAR(top.contour.at(0).end.h, 1, 1e-15);
    EXPECT_NEAR(below.contour.at(0).end.h, -1, 1e-15);
}

TEST(ContourReader, LetsArcsTouchTheAxis) {
    // A sphere's outline, from pole to pole, and a horn torus, which touches the axis on its way.
    EXPECT_THAT(shape_of("AN 0 -1 KR 1 0 0 1").contour, SizeIs(2));
    const RotationalShape horn = shape_of("AN 1 1 KR 0 0 1 -1");
    for (const ContourPiece& piece : horn.contour)
        EXPECT_GE(piece.end.r, 0);
}

TEST(ContourReader, TellsOfCirclesThatRoundingLeavesNothingOf) {
    EXPECT_EQ(
        said_of(within_scene("RS 0 0 0 V 0 0 1 AN 0 0 KR 1e120 0 0 1e120")),
        "test.vera:2:25: error: the arc's three points are too far apart, or too close to one "
        "line, for a circle\n"
        "    RS 0 0 0 V 0 0 1 AN 0 0 KR 1e120 0 0 1e120\n"
        "                            ^~\n"
        "  write GE for a straight line\n");
}

TEST(ContourReader, BreaksContoursAtPiecesWithoutArea) {
    const SceneFile file = read_text(
        within_scene("RS 0 0 0 V 0 0 1 AN 1 0 GE 1 0 GE 0 0 GE 0 5 GE 1 5 GE 0 6 GE 0 7"));
    const auto& shapes = file.scene.geometry.rotational_shapes;
    ASSERT_THAT(shapes, SizeIs(2));
    EXPECT_THAT(shapes[0].contour, SizeIs(1));
    EXPECT_EQ(shapes[1].start, (ContourPiece::Point{0, 5}));
    EXPECT_THAT(shapes[1].contour, SizeIs(2));
    EXPECT_THAT(file.warnings, SizeIs(3));
}

TEST(ContourReader, LetsCurvesReachButNotCrossTheAxis) {
    // With its least r exactly 0, at t = 1/2, and just below.
    EXPECT_EQ(said_of(within_scene("RS 0 0 0 V 0 0 1 AN 3 0 KU -1 1 -1 2 3 3")), "");
    EXPECT_NE(said_of(within_scene("RS 0 0 0 V 0 0 1 AN 3 0 KU -1.001 1 -1.001 2 3 3")), "");
    EXPECT_EQ(said_of(within_scene("RS 0 0 0 V 0 0 1 AN 1 0 KE -1 1 1 1 3")), "");
    EXPECT_NE(said_of(within_scene("RS 0 0 0 V 0 0 1 AN 1 0 KE -1.001 1 1 1 3")), "");
}

} // namespace
} // namespace vera
