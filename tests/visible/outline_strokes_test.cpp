// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/elliptic_arc.h"
#include "vera/visible/draw_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "accel/random_scene.h"
#include "scene/make_scene.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using test::add;
using test::add_polygon;

/// From the front and above, at an angle; in perspective or not.
Camera camera_from_above(bool is_parallel) {
    const Vec3 to = normalized(Vec3{-0.35, -0.5, -1});
    const Vec3 across = normalized(cross(to, {0, 1, 0}));
    const Vec3 up = cross(across, to);
    Camera camera;
    camera.projection =
        is_parallel ? Camera::Projection::parallel : Camera::Projection::perspective;
    camera.viewpoint = -12 * to;
    camera.direction = to;
    camera.lower_left = -3 * across - 3 * up;
    camera.lower_right = 3 * across - 3 * up;
    camera.upper_left = -3 * across + 3 * up;
    return camera;
}

/// Along an axis: what is behind lies exactly behind.
Camera camera_from_the_front() {
    Camera camera;
    camera.projection = Camera::Projection::parallel;
    camera.direction = {0, 0, -1};
    camera.lower_left = {-3, -3, 0};
    camera.lower_right = {3, -3, 0};
    camera.upper_left = {-3, 3, 0};
    return camera;
}

std::vector<Stroke> lines_of(
    Scene scene,
    const Camera& camera,
    DrawingStyle style = DrawingStyle::lines,
    double deviation = 0.1) {
    number_primitives(scene);
    DrawSettings settings;
    settings.style = style;
    settings.deviation = deviation;
    const DrawnScene drawn = draw_scene(scene, camera, {}, settings);
    EXPECT_TRUE(drawn.drawing.fills.empty());
    return drawn.drawing.strokes;
}

std::map<LineClass, int> counts(const std::vector<Stroke>& strokes) {
    std::map<LineClass, int> result;
    for (const Stroke& stroke : strokes)
        ++result[stroke.line_class];
    return result;
}

double sweep_of(const DrawingArc& arc) {
    return arc.end_degrees - arc.begin_degrees;
}

/// Every arc begins and ends at the points of its segment.
void expect_arcs_at_their_points(const std::vector<Stroke>& strokes) {
    for (const Stroke& stroke : strokes)
        for (const DrawingArc& arc : stroke.arcs) {
            ASSERT_LT(arc.segment, stroke.points.size());
            const std::size_t next = arc.segment + 1 == stroke.points.size() ? 0 : arc.segment + 1;
            EXPECT_LE(
                distance(point_at(arc.ellipse, arc.begin_degrees), stroke.points[arc.segment]),
                0.01);
            EXPECT_LE(distance(point_at(arc.ellipse, arc.end_degrees), stroke.points[next]), 0.01);
        }
}

void add_block(Geometry& geometry, Vec3 low, Vec3 high) {
    const auto corner = [&](int i) {
        return Vec3{
            (i & 1) != 0 ? high.x : low.x,
            (i & 2) != 0 ? high.y : low.y,
            (i & 4) != 0 ? high.z : low.z};
    };
    const int sides[6][4] = {
        {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& side : sides)
        add_polygon(geometry, {corner(side[0]), corner(side[1]), corner(side[2]), corner(side[3])});
}

RotationalShape cylinder(Vec3 base, double radius, double height) {
    RotationalShape shape;
    shape.base = base;
    shape.axis = {0, 1, 0};
    const auto line_to = [&](double r, double h) {
        ContourPiece piece;
        piece.end = {r, h};
        shape.contour.push_back(piece);
    };
    line_to(radius, 0);
    line_to(radius, height);
    line_to(0, height);
    return shape;
}

TEST(OutlineStrokes, OfABallAreOneWholeEllipseHoweverFewItsFacets) {
    for (const bool is_parallel : {false, true})
        for (const double deviation : {0.05, 0.5, 4.0})
            for (const DrawingStyle style : {DrawingStyle::lines, DrawingStyle::hidden_lines}) {
                Scene scene;
                add(scene.geometry, Sphere{{0.3, 0.2, -0.4}, 1.3});
                const auto strokes =
                    lines_of(scene, camera_from_above(is_parallel), style, deviation);
                ASSERT_EQ(strokes.size(), 1U) << is_parallel << deviation;
                EXPECT_TRUE(strokes[0].closed);
                EXPECT_EQ(strokes[0].line_class, LineClass::silhouette);
                EXPECT_EQ(strokes[0].points.size(), 1U);
                ASSERT_EQ(strokes[0].arcs.size(), 1U);
                EXPECT_EQ(std::abs(sweep_of(strokes[0].arcs[0])), 360);
                // Of radius 1.3 where 6 are 512 pixels.
                const double radius = distance(strokes[0].arcs[0].ellipse.minor, {});
                if (is_parallel) {
                    EXPECT_NEAR(radius, 1.3 * 512 / 6, 1e-6);
                }
                expect_arcs_at_their_points(strokes);
            }
}

TEST(OutlineStrokes, EndAnArcWhereAnotherCoversIt) {
    Scene scene;
    add(scene.geometry, Sphere{{-0.5, 0, 2}, 1});
    add(scene.geometry, Sphere{{0.8, 0, -1}, 1.2});
    for (const double deviation : {0.1, 1.0}) {
        const auto strokes =
            lines_of(scene, camera_from_the_front(), DrawingStyle::hidden_lines, deviation);
        ASSERT_EQ(
            counts(strokes),
            (std::map<LineClass, int>{{LineClass::hidden, 1}, {LineClass::silhouette, 2}}));
        expect_arcs_at_their_points(strokes);
        const auto is_whole = [](const Stroke& stroke) { return stroke.closed; };
        const auto front = std::find_if(strokes.begin(), strokes.end(), is_whole);
        ASSERT_NE(front, strokes.end());
        const DrawingEllipse& circle = front->arcs.at(0).ellipse;
        EXPECT_NEAR(distance(circle.major, {}), 512 / 6.0, 1e-6);
        double whole = 0;
        for (const Stroke& stroke : strokes) {
            if (stroke.closed)
                continue;
            ASSERT_EQ(stroke.arcs.size(), 1U);
            ASSERT_EQ(stroke.points.size(), 2U);
            // Where the exact outlines cross, not where the facets' do.
            for (const DrawingPoint& end : stroke.points)
                EXPECT_NEAR(distance(end, circle.center), 512 / 6.0, 1e-3);
            whole += std::abs(sweep_of(stroke.arcs[0]));
        }
        EXPECT_NEAR(whole, 360, 1e-6);
    }
}

/// A ball, or a ring about it, of quarter circles.
RotationalShape arcs(double radius, double r, Vec3 axis) {
    RotationalShape shape;
    shape.axis = normalized(axis);
    const auto arc_to = [&](ContourPiece::Point control, ContourPiece::Point end) {
        ContourPiece piece;
        piece.kind = ContourPiece::Kind::conic;
        piece.control[0] = control;
        piece.weight = std::sqrt(0.5);
        piece.end = end;
        shape.contour.push_back(piece);
    };
    shape.start = {radius, -r};
    arc_to({radius + r, -r}, {radius + r, 0});
    arc_to({radius + r, r}, {radius, r});
    if (radius > 0) {
        arc_to({radius - r, r}, {radius - r, 0});
        arc_to({radius - r, -r}, {radius, -r});
    }
    return shape;
}

TEST(OutlineStrokes, OfABallThatIsARotationalShapeAreOneEllipseToo) {
    Scene scene;
    add(scene.geometry, arcs(0, 1.2, {0.3, 1, 0.2}));
    for (const double deviation : {0.1, 2.0}) {
        const auto strokes =
            lines_of(scene, camera_from_above(false), DrawingStyle::hidden_lines, deviation);
        ASSERT_EQ(strokes.size(), 1U) << deviation;
        EXPECT_EQ(strokes[0].points.size(), 1U);
        EXPECT_EQ(strokes[0].arcs.size(), 1U);
    }
}

double length_of(const Stroke& stroke) {
    double sum = 0;
    for (std::size_t i = 1; i < stroke.points.size(); ++i)
        sum += distance(stroke.points[i - 1], stroke.points[i]);
    return stroke.closed ? sum + distance(stroke.points.back(), stroke.points.front()) : sum;
}

TEST(OutlineStrokes, DrawTheSilhouettesOfARingOnce) {
    // As the camera sees it, its axis at 25 degrees. Its outlines lie on both sides of the ellipse
    // that its middle circle is seen as, everywhere as far from it: together they are twice as
    // long.
    Scene scene;
    const double turn = 25 / 57.29577951308232;
    add(scene.geometry, arcs(1.2, 0.4, {0, std::sin(turn), std::cos(turn)}));
    double perimeter = 0;
    constexpr int parts = 1000;
    const auto place = [&](int i) {
        const double angle = 2 * 3.141592653589793 * i / parts;
        return DrawingPoint{1.2 * std::cos(angle), 1.2 * std::cos(turn) * std::sin(angle)};
    };
    for (int i = 0; i < parts; ++i)
        perimeter += distance(place(i), place(i + 1)) * 512 / 6;
    for (const double deviation : {0.05, 0.5}) {
        const auto strokes =
            lines_of(scene, camera_from_the_front(), DrawingStyle::hidden_lines, deviation);
        const auto all = counts(strokes);
        EXPECT_EQ(all.size(), 1U) << deviation; // nothing hidden
        EXPECT_LE(all.at(LineClass::silhouette), 6) << deviation;
        double sum = 0;
        for (const Stroke& stroke : strokes)
            sum += length_of(stroke);
        EXPECT_NEAR(sum, 2 * perimeter, 0.01 * perimeter) << deviation;
    }
}

TEST(OutlineStrokes, TellCreasesFromWhereAThingStandsOnAnother) {
    Scene scene;
    add(scene.geometry, cylinder({0, -1, 0}, 0.8, 1.5));
    add_polygon(scene.geometry, {{-20, -1, -60}, {-20, -1, 9}, {20, -1, 9}, {20, -1, -60}});
    for (const bool is_parallel : {false, true}) {
        const auto strokes = lines_of(scene, camera_from_above(is_parallel));
        // Of the circles, each is an arc alone; the sides and the upper circle's far part are one
        // line.
        EXPECT_EQ(
            counts(strokes),
            (std::map<LineClass, int>{
                {LineClass::intersection, 1}, {LineClass::crease, 1}, {LineClass::silhouette, 1}}))
            << is_parallel;
        expect_arcs_at_their_points(strokes);
        for (const Stroke& stroke : strokes) {
            EXPECT_FALSE(stroke.closed);
            ASSERT_EQ(stroke.arcs.size(), 1U);
            EXPECT_NEAR(std::abs(sweep_of(stroke.arcs[0])), 180, 15);
            EXPECT_EQ(stroke.points.size(), stroke.line_class == LineClass::silhouette ? 4U : 2U);
        }
    }
}

TEST(OutlineStrokes, CallWhatPassesThroughEachOtherAnIntersection) {
    Scene two;
    add_polygon(two.geometry, {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
    add_polygon(two.geometry, {{0, -1, -1}, {0, -1, 1}, {0, 1, 1}, {0, 1, -1}});
    // Of one thing as well.
    Scene one;
    Mesh mesh;
    mesh.positions = {
        {-2, -2, 0}, {2, -2, 0}, {0, 2, 0}, {0, -1, -1}, {0, -1, 1}, {0, 1, 1}, {0, 1, -1}};
    mesh.position_indices = {0, 1, 2, 3, 4, 5, 3, 5, 6};
    add(one.geometry, std::move(mesh));
    for (const Scene& scene : {two, one}) {
        const auto strokes = lines_of(scene, camera_from_above(true));
        const auto all = counts(strokes);
        EXPECT_EQ(all.count(LineClass::crease), 0U);
        ASSERT_EQ(all.at(LineClass::intersection), 1);
        EXPECT_EQ(strokes.front().points.size(), 2U); // one straight line, however it was cut
    }
}

TEST(OutlineStrokes, OfABlockHaveThreeHiddenEdges) {
    Scene scene;
    add_block(scene.geometry, {-1, -1, -1}, {1, 1, 1});
    for (const bool is_parallel : {false, true}) {
        const auto strokes =
            lines_of(scene, camera_from_above(is_parallel), DrawingStyle::hidden_lines);
        EXPECT_EQ(
            counts(strokes),
            (std::map<LineClass, int>{
                {LineClass::hidden, 3}, {LineClass::crease, 3}, {LineClass::silhouette, 1}}))
            << is_parallel;
        for (const Stroke& stroke : strokes)
            EXPECT_EQ(stroke.points.size(), stroke.closed ? 6U : 2U);
    }
}

TEST(OutlineStrokes, DrawNoHiddenLineBehindOneThatIsSeen) {
    Scene scene;
    add_block(scene.geometry, {-1, -1, -1}, {1, 1, 1});
    const auto strokes = lines_of(scene, camera_from_the_front(), DrawingStyle::hidden_lines);
    EXPECT_EQ(counts(strokes), (std::map<LineClass, int>{{LineClass::silhouette, 1}}));
    // Nor twice what two edges have behind a wall.
    add_polygon(scene.geometry, {{-2, -2, 2}, {2, -2, 2}, {2, 2, 2}, {-2, 2, 2}});
    const auto covered = lines_of(scene, camera_from_the_front(), DrawingStyle::hidden_lines);
    EXPECT_EQ(
        counts(covered),
        (std::map<LineClass, int>{{LineClass::hidden, 1}, {LineClass::silhouette, 1}}));
    EXPECT_TRUE(covered[0].closed);
    EXPECT_EQ(covered[0].points.size(), 4U);
}

TEST(OutlineStrokes, DashOfWhatIsCoveredAsMuchAsIsCovered) {
    Scene scene;
    add_polygon(scene.geometry, {{-1, -2, 1}, {1, -2, 1}, {1, 2, 1}, {-1, 2, 1}});
    add_polygon(scene.geometry, {{-2, -1, 0}, {2, -1, 0}, {2, 1, 0}, {-2, 1, 0}});
    const auto strokes = lines_of(scene, camera_from_the_front(), DrawingStyle::hidden_lines);
    int hidden = 0;
    for (const Stroke& stroke : strokes)
        if (stroke.line_class == LineClass::hidden) {
            ++hidden;
            ASSERT_EQ(stroke.points.size(), 2U);
            // The ends are at x = -1 and 1, which are 512 / 6 pixels from the middle.
            EXPECT_NEAR(distance(stroke.points[0], stroke.points[1]), 512 / 3.0, 1e-3);
            EXPECT_NEAR(stroke.points[0].x + stroke.points[1].x, 512, 1e-3);
        }
    EXPECT_EQ(hidden, 2);
}

TEST(OutlineStrokes, DashWhatIsHiddenOfAnIntersection) {
    // A plate that another passes through along x = 0, and a third one before their upper half.
    Scene scene;
    add_polygon(scene.geometry, {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
    add_polygon(scene.geometry, {{-1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, -1}});
    add_polygon(scene.geometry, {{-2.5, 0, 2}, {2.5, 0, 2}, {2.5, 2.5, 2}, {-2.5, 2.5, 2}});
    const Camera camera = camera_from_the_front();
    for (const DrawingStyle style : {DrawingStyle::lines, DrawingStyle::hidden_lines}) {
        double seen = 0;
        double hidden = 0;
        for (const Stroke& stroke : lines_of(scene, camera, style)) {
            const bool is_upright = stroke.points.size() == 2
                && std::abs(stroke.points[0].x - 256) < 0.01
                && std::abs(stroke.points[1].x - 256) < 0.01;
            if (is_upright && stroke.line_class == LineClass::intersection)
                seen += distance(stroke.points[0], stroke.points[1]);
            if (is_upright && stroke.line_class == LineClass::hidden)
                hidden += distance(stroke.points[0], stroke.points[1]);
        }
        EXPECT_NEAR(seen, 512 / 6.0, 1e-2);
        EXPECT_NEAR(hidden, style == DrawingStyle::lines ? 0 : 512 / 6.0, 1e-2);
    }
}

double distance_to_segment(DrawingPoint at, DrawingPoint from, DrawingPoint to) {
    const double x = to.x - from.x;
    const double y = to.y - from.y;
    const double squared = x * x + y * y;
    const double along = squared > 0 ? ((at.x - from.x) * x + (at.y - from.y) * y) / squared : 0;
    const double part = std::clamp(along, 0.0, 1.0);
    return distance(at, {from.x + part * x, from.y + part * y});
}

/// From a place that none of the faces' planes comes through.
Camera camera_from_aside() {
    Camera camera;
    camera.viewpoint = {1.137, 1.291, 9.713};
    const Vec3 to = normalized(-camera.viewpoint);
    const Vec3 across = normalized(cross(to, {0, 1, 0}));
    const Vec3 up = cross(across, to);
    const Vec3 middle = camera.viewpoint + to;
    camera.lower_left = middle - 0.4 * across - 0.4 * up;
    camera.lower_right = middle + 0.4 * across - 0.4 * up;
    camera.upper_left = middle - 0.4 * across + 0.4 * up;
    return camera;
}

/// Where faces pass through each other within a step of an edge, lines are made of what joins the
/// borders of both: they too must lie on a border, and leave no corner of it out.
TEST(OutlineStrokes, LieOnBordersOfWhatIsSeen) {
    std::mt19937_64 random(4);
    const auto coordinate = [&] { return static_cast<double>(random() % 5) - 2; };
    std::size_t intersections = 0;
    for (int round = 0; round < 120; ++round) {
        Scene scene;
        for (int i = 0; i < 10; ++i) {
            std::vector<Vec3> corners(3);
            for (Vec3& corner : corners)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    corner[axis] = coordinate();
            const Vec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
            if (dot(normal, normal) > 0)
                add_polygon(scene.geometry, corners);
        }
        number_primitives(scene);
        const Drawing areas = draw_scene(scene, camera_from_aside(), {}, {}).drawing;
        for (const Stroke& stroke : lines_of(scene, camera_from_aside())) {
            intersections += stroke.line_class == LineClass::intersection ? 1 : 0;
            ASSERT_TRUE(stroke.arcs.empty());
            for (std::size_t i = 0; i + (stroke.closed ? 0 : 1) < stroke.points.size(); ++i) {
                const DrawingPoint from = stroke.points[i];
                const DrawingPoint to = stroke.points[(i + 1) % stroke.points.size()];
                const DrawingPoint middle = {(from.x + to.x) / 2, (from.y + to.y) / 2};
                double nearest = 1e9;
                for (const FilledOutline& fill : areas.fills)
                    for (const auto& ring : fill.rings)
                        for (std::size_t k = 0; k < ring.size(); ++k)
                            nearest = std::min(
                                nearest,
                                distance_to_segment(middle, ring[k], ring[(k + 1) % ring.size()]));
                ASSERT_LT(nearest, 0.01) << "round " << round << ": " << from.x << ' ' << from.y
                                         << " to " << to.x << ' ' << to.y;
            }
        }
    }
    EXPECT_GT(intersections, 100U);
}

TEST(OutlineStrokes, OfRandomScenesAreFiniteInTheFrameAndWhole) {
    constexpr double deviation = 0.5;
    std::size_t arc_count = 0;
    for (std::uint64_t seed = 0; seed < 24 && !HasFailure(); ++seed) {
        testing::RandomSceneSettings settings;
        settings.items = 4 + seed % 3 * 6;
        const auto strokes = lines_of(
            testing::random_scene(seed, settings),
            camera_from_above(seed % 2 == 0),
            DrawingStyle::hidden_lines,
            deviation);
        for (const Stroke& stroke : strokes) {
            const std::size_t segments = stroke.points.size() - (stroke.closed ? 0 : 1);
            ASSERT_GE(segments, 1U) << seed;
            for (const DrawingPoint& point : stroke.points) {
                EXPECT_TRUE(point.x > -3 && point.x < 515) << seed << ' ' << point.x;
                EXPECT_TRUE(point.y > -3 && point.y < 515) << seed << ' ' << point.y;
            }
            for (std::size_t i = 0; i < stroke.arcs.size(); ++i) {
                const DrawingArc& arc = stroke.arcs[i];
                ++arc_count;
                ASSERT_LT(arc.segment, segments) << seed;
                EXPECT_TRUE(i == 0 || stroke.arcs[i - 1].segment < arc.segment) << seed;
                EXPECT_LE(std::abs(sweep_of(arc)), 360) << seed;
                const std::size_t next =
                    arc.segment + 1 == stroke.points.size() ? 0 : arc.segment + 1;
                // Where two outlines all but touch, the place is on one of them alone.
                const DrawingPoint begin = point_at(arc.ellipse, arc.begin_degrees);
                const DrawingPoint end = point_at(arc.ellipse, arc.end_degrees);
                EXPECT_LE(distance(begin, stroke.points[arc.segment]), 3 * deviation) << seed;
                EXPECT_LE(distance(end, stroke.points[next]), 3 * deviation) << seed;
            }
        }
    }
    EXPECT_GT(arc_count, 100U);
}

TEST(OutlineStrokes, DrawBladesAndFlatAnglesByTheAngleThatIsSeen) {
    // Two sides that meet at 20 degrees, seen on the edge between them; and two at 160.
    for (const bool is_sharp : {true, false}) {
        Scene scene;
        Mesh mesh;
        const double back = is_sharp ? -5 : -0.15;
        mesh.positions = {{0, -1, 0}, {0, 1, 0}, {-0.9, 0, back}, {0.9, 0, back}};
        mesh.position_indices = {0, 1, 2, 1, 0, 3};
        add(scene.geometry, std::move(mesh));
        const auto all = counts(lines_of(scene, camera_from_the_front()));
        EXPECT_EQ(all.count(LineClass::crease), is_sharp ? 1U : 0U);
        EXPECT_EQ(all.at(LineClass::silhouette), 1);
    }
}

// A strip that bends by 15 degrees at each side, as triangles of a mesh and as patches of a text.
TEST(OutlineStrokes, DrawPatchesWithTheSameNormalsAsOneSurface) {
    constexpr std::uint32_t sides = 6;
    Mesh mesh;
    for (std::uint32_t i = 0; i <= sides; ++i) {
        const double angle = 0.26 * (static_cast<double>(i) - sides / 2.0);
        for (const double y : {-1.0, 1.0}) {
            mesh.positions.push_back({2 * std::sin(angle), y, 2 * std::cos(angle) - 2});
            mesh.normals.push_back({std::sin(angle), 0, std::cos(angle)});
        }
    }
    for (std::uint32_t i = 0; i < sides; ++i)
        for (const std::uint32_t corner : {0U, 2U, 1U, 1U, 2U, 3U})
            mesh.position_indices.push_back(2 * i + corner);
    const auto as_patches = [&](double lean) {
        Scene scene;
        for (std::size_t i = 0; i < mesh.position_indices.size(); i += 3) {
            Patch patch;
            for (std::size_t c = 0; c < 3; ++c) {
                patch.corners[c] = mesh.positions[mesh.position_indices[i + c]];
                patch.normals[c] = mesh.normals[mesh.position_indices[i + c]];
                // From one patch to the next it is another one.
                patch.normals[c].y += lean * static_cast<double>(i);
            }
            add(scene.geometry, patch);
        }
        return counts(lines_of(scene, camera_from_the_front()));
    };
    Scene scene;
    add(scene.geometry, mesh);
    const auto of_mesh = counts(lines_of(scene, camera_from_the_front()));
    EXPECT_EQ(of_mesh, (std::map<LineClass, int>{{LineClass::silhouette, 1}}));
    EXPECT_EQ(as_patches(0), of_mesh);
    EXPECT_GT(as_patches(0.001).at(LineClass::crease), 0);
}

} // namespace
} // namespace vera
