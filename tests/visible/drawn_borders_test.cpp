// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/drawing/elliptic_arc.h"
#include "vera/visible/draw_scene.h"
#include "vera/visible/drawn_borders.h"
#include "vera/visible/penetrations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "scene/make_scene.h"
#include "visible/painted_color.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using test::add;
using test::add_polygon;

constexpr double wide = 300; // pixels
constexpr double high = 240;

/// At the origin, from the front, above or at an angle; pixels that are not square.
Camera camera_towards(Vec3 to, bool is_parallel, double distance = 10) {
    to = normalized(to);
    const Vec3 across = normalized(cross(to, std::abs(to.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{0, 0, 1}));
    const Vec3 up = cross(across, to);
    Camera camera;
    camera.projection =
        is_parallel ? Camera::Projection::parallel : Camera::Projection::perspective;
    camera.viewpoint = -distance * to;
    camera.direction = to;
    camera.lower_left = -3 * across - 3 * up;
    camera.lower_right = 3 * across - 3 * up;
    camera.upper_left = -3 * across + 3 * up;
    return camera;
}

/// Of straight pieces through these points: radius, and height along the axis.
RotationalShape
turned_shape(Vec3 base, Vec3 axis, const std::vector<ContourPiece::Point>& contour) {
    RotationalShape shape;
    shape.base = base;
    shape.axis = normalized(axis);
    shape.start = contour.front();
    for (std::size_t i = 1; i < contour.size(); ++i) {
        ContourPiece piece;
        piece.end = contour[i];
        shape.contour.push_back(piece);
    }
    return shape;
}

RotationalShape cylinder(Vec3 base, Vec3 axis, double radius, double height) {
    return turned_shape(base, axis, {{0, 0}, {radius, 0}, {radius, height}, {0, height}});
}

RotationalShape cone(Vec3 base, Vec3 axis, double radius, double height) {
    return turned_shape(base, axis, {{0, 0}, {radius, 0}, {0, height}});
}

/// Behind all, beyond the frame on every side.
void add_wall(Geometry& geometry, const Camera& camera) {
    const Vec3 to = normalized(
        cross(camera.lower_right - camera.lower_left, camera.upper_left - camera.lower_left));
    const Vec3 across = 20.0 / 6 * (camera.lower_right - camera.lower_left);
    const Vec3 up = 20.0 / 6 * (camera.upper_left - camera.lower_left);
    const Vec3 middle = -8 * to;
    add_polygon(
        geometry,
        {middle - across - up, middle + across - up, middle + across + up, middle - across + up});
}

struct DrawnMap {
    Facets all;
    DrawnFaces faces;
    VisibleMap map;
    DrawnBorders straight;
    DrawnBorders curved;
    double tolerance = 0;
};

PictureSettings settings_of_picture() {
    PictureSettings picture;
    picture.width = static_cast<std::uint32_t>(wide);
    picture.height = static_cast<std::uint32_t>(high);
    return picture;
}

DrawnMap drawn_map(const Scene& scene, const Camera& camera, FaceUnit unit, double deviation) {
    const CameraMap camera_map(camera);
    const PictureSettings picture = settings_of_picture();
    DrawnMap drawn;
    drawn.all = facets(scene, [&](Vec3 point) {
        return deviation * camera_map.size_of_pixel(picture.width, picture.height, point);
    });
    const DrawnFaces planes = drawn_faces(scene, drawn.all, FaceUnit::plane, camera);
    drawn.faces = drawn_faces(scene, drawn.all, unit, camera);
    ScreenScene screen = screen_scene(drawn.all, camera_map, planes.of_facet);
    sort_by_place(screen);
    VisiblePieces pieces = whole_pieces(screen).pieces;
    join_sources(screen, pieces, planes, drawn.faces);
    drawn.map = visible_map(screen, pieces);
    drawn.straight = straight_borders(drawn.map, picture);
    drawn.curved = curved_borders(
        {scene, camera, camera_map, picture, drawn.all, drawn.faces, drawn.map, deviation});
    drawn.tolerance = curve_tolerance(picture, deviation);
    return drawn;
}

std::vector<FilledOutline> outlines(const DrawnMap& drawn, const DrawnBorders& borders) {
    std::vector<FilledOutline> all(drawn.map.regions.size());
    for (const VisibleMap::Ring& ring : drawn.map.rings)
        add_ring(borders.ring(drawn.map, ring), borders.curves.all(), all[ring.region]);
    return all;
}

/// By Green: the polygon through the points, and beyond each chord the segment of the ellipse.
double area_of(const FilledOutline& outline) {
    double area = testing::doubled_area(outline.rings) / 2;
    for (const auto& arcs : outline.arcs)
        for (const DrawingArc& arc : arcs) {
            const double radians = (arc.end_degrees - arc.begin_degrees) * 3.14159265358979 / 180;
            area += distance(arc.ellipse.major, {}) * distance(arc.ellipse.minor, {}) / 2
                * (radians - std::sin(radians));
        }
    return area;
}

double distance_to_segment(DrawingPoint p, DrawingPoint a, DrawingPoint b) {
    const double x = b.x - a.x;
    const double y = b.y - a.y;
    const double squared = x * x + y * y;
    const double along =
        squared > 0 ? std::clamp(((p.x - a.x) * x + (p.y - a.y) * y) / squared, 0.0, 1.0) : 0;
    return distance(p, {a.x + along * x, a.y + along * y});
}

/// A ring, and the box about it.
struct BoxedRing {
    PointChain points;
    DrawingPoint least = {1e300, 1e300};
    DrawingPoint most = {-1e300, -1e300};
};

void add_boxed(const std::vector<PointChain>& rings, std::vector<BoxedRing>& boxed) {
    for (const PointChain& points : rings) {
        BoxedRing& ring = boxed.emplace_back();
        ring.points = points;
        for (const DrawingPoint point : points) {
            ring.least = {std::min(ring.least.x, point.x), std::min(ring.least.y, point.y)};
            ring.most = {std::max(ring.most.x, point.x), std::max(ring.most.y, point.y)};
        }
    }
}

/// Whether the rings pass that near to the point.
bool pass_near(const std::vector<BoxedRing>& rings, DrawingPoint point, double near) {
    for (const auto& [points, least, most] : rings) {
        if (point.x < least.x - near || point.x > most.x + near || point.y < least.y - near
            || point.y > most.y + near)
            continue;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (distance_to_segment(point, points[i], points[i + 1 == points.size() ? 0 : i + 1])
                <= near)
                return true;
    }
    return false;
}

/// How far the ray through the point passes by the nearest outline of a sphere or circle of a
/// rotational shape, by the lengths of vectors alone.
double off_exact_outlines(const Geometry& geometry, const Camera& camera, DrawingPoint point) {
    const Ray ray = view_ray(camera, point.x / wide, point.y / high);
    double nearest = 1e300;
    for (const Sphere& sphere : geometry.spheres) {
        const Vec3 to = sphere.center - ray.origin;
        const Vec3 off = to - dot(to, ray.direction) * ray.direction;
        nearest = std::min(nearest, std::abs(length(off) - sphere.radius));
    }
    for (const RotationalShape& shape : geometry.rotational_shapes) {
        std::vector<ContourPiece::Point> circles = {shape.start};
        for (const ContourPiece& piece : shape.contour)
            circles.push_back(piece.end);
        for (const ContourPiece::Point& circle : circles) {
            const Vec3 center = shape.base + circle.h * shape.axis;
            const double t = dot(center - ray.origin, shape.axis) / dot(ray.direction, shape.axis);
            nearest = std::min(nearest, std::abs(length(point_at(ray, t) - center) - circle.r));
        }
    }
    return nearest;
}

/// Both regions beside a border draw the same, and the curves are exact outlines.
void expect_common_curves(
    const Scene& scene, const Camera& camera, const DrawnMap& drawn, const std::string& what) {
    const VisibleMap& map = drawn.map;
    using Way = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
    std::map<Way, std::uint32_t> curves;
    std::set<std::uint32_t> used;
    for (const VisibleMap::Ring& ring : map.rings)
        for (std::size_t i = 0; i < ring.count; ++i) {
            const std::size_t place = ring.first + i;
            const std::uint32_t to = map.ring_vertices[ring.first + (i + 1) % ring.count];
            const std::uint32_t curve = drawn.curved.point(map, place).curve;
            curves[{map.ring_vertices[place], to, ring.region, map.ring_across[place]}] = curve;
            if (curve != no_curve)
                used.insert(curve);
        }
    for (const auto& [way, curve] : curves) {
        const auto& [from, to, region, across] = way;
        if (across == no_region || curve == no_curve)
            continue;
        const auto back = curves.find({to, from, across, region});
        ASSERT_NE(back, curves.end()) << what;
        EXPECT_EQ(back->second, curve) << what;
    }
    for (const std::uint32_t curve : used)
        for (double angle = 0; angle < 360; angle += 30)
            EXPECT_LE(
                off_exact_outlines(
                    scene.geometry, camera, point_at(drawn.curved.curves.all()[curve], angle)),
                1e-7)
                << what;
}

void expect_frame_kept(const DrawnMap& drawn, const std::string& what) {
    for (std::size_t i = 0; i < drawn.map.vertices.size(); ++i) {
        const DrawingPoint from = drawn.straight.places[i];
        const DrawingPoint to = drawn.curved.places[i];
        if (from.x == 0 || from.x == wide) {
            EXPECT_EQ(to.x, from.x) << what;
        }
        if (from.y == 0 || from.y == high) {
            EXPECT_EQ(to.y, from.y) << what;
        }
    }
}

/// Nothing is moved farther than may be, and all areas make up the frame.
void expect_sound(
    const Scene& scene, const Camera& camera, const DrawnMap& drawn, const std::string& what) {
    expect_common_curves(scene, camera, drawn, what);
    expect_frame_kept(drawn, what);
    const auto before = outlines(drawn, drawn.straight);
    const auto after = outlines(drawn, drawn.curved);
    double area_before = 0;
    double area_after = 0;
    std::vector<BoxedRing> all_before;
    std::vector<BoxedRing> all_after;
    for (std::size_t i = 0; i < before.size(); ++i) {
        area_before += area_of(before[i]);
        area_after += area_of(after[i]);
        add_boxed(testing::flattened_rings(before[i]), all_before);
        add_boxed(testing::flattened_rings(after[i]), all_after);
    }
    // Along lines that cross an outline at a slant a corner may move farther; borders do not.
    for (const auto& [rings, others] :
         {std::pair(&all_after, &all_before), std::pair(&all_before, &all_after)})
        for (const BoxedRing& ring : *rings)
            for (const DrawingPoint point : ring.points)
                EXPECT_TRUE(pass_near(*others, point, 1.01 * drawn.tolerance))
                    << what << " at " << point.x << ' ' << point.y;
    // An outline that all but touches the frame may reach beyond it where its facets do not.
    double beyond = 0;
    for (const BoxedRing& ring : all_after)
        beyond = std::max(
            {beyond, -ring.least.x, ring.most.x - wide, -ring.least.y, ring.most.y - high});
    EXPECT_LE(beyond, drawn.tolerance) << what;
    EXPECT_NEAR(area_before, wide * high, drawn.map.joined == 0 ? 1e-6 : 0.1) << what;
    EXPECT_NEAR(area_after, area_before, 1e-6 + beyond * 2 * (wide + high)) << what;
}

struct NamedScene {
    std::string name;
    Scene scene;
    Camera camera;
};

/// What makes borders coincide, touch, vanish and end.
std::vector<NamedScene> degenerate_scenes() {
    std::vector<NamedScene> all;
    const auto begin = [&](const char* name, const Camera& camera) -> Geometry& {
        all.push_back({name, {}, camera});
        return all.back().scene.geometry;
    };
    const Camera front = camera_towards({0, 0, -1}, true);
    const Camera near = camera_towards({0, 0, -1}, false, 4);
    const Camera above = camera_towards({-0.3, -0.6, -1}, false);
    {
        Geometry& geometry = begin("a ball alone", above);
        add(geometry, Sphere{{0.2, 0, 0}, 1});
    }
    {
        Geometry& geometry = begin("balls cut by the frame", front);
        add(geometry, Sphere{{3, 0, 0}, 1});
        add(geometry, Sphere{{-3, 3, 0}, 1});
        add(geometry, Sphere{{0, -2, 0}, 1}); // which it touches
        add(geometry, Sphere{{0, 2.001, 0}, 1});
    }
    {
        Geometry& geometry = begin("a ball that reaches to the viewer", near);
        add(geometry, Sphere{{0.5, 0, 3}, 1.2});
        add(geometry, Sphere{{-1, -1, 3.9}, 0.4});
    }
    {
        Geometry& geometry = begin("balls behind each other", front);
        add(geometry, Sphere{{-0.5, 0, 2}, 1});
        add(geometry, Sphere{{0.8, 0, -1}, 1.2});
        add(geometry, Sphere{{0, 0.9, 0}, 1});
    }
    {
        Geometry& geometry = begin("balls that touch", front);
        add(geometry, Sphere{{-1, 0, 0}, 1});
        add(geometry, Sphere{{1, 0, 0}, 1});
        add(geometry, Sphere{{0, 1.5, -1}, 0.5}); // in the picture alone
        add(geometry, Sphere{{-1, 0.5, 2}, 0.5}); // from within
    }
    {
        Geometry& geometry = begin("the same ball twice", front);
        add(geometry, Sphere{{0, 0, 0}, 1});
        add(geometry, Sphere{{0, 0, 0}, 1});
        add(geometry, Sphere{{0, 0, -2}, 1});
    }
    {
        Geometry& geometry = begin("balls that pass through each other", above);
        add(geometry, Sphere{{-0.5, 0, 0}, 1});
        add(geometry, Sphere{{0.5, 0, 0}, 1});
        add(geometry, Sphere{{0, 0.3, 0}, 1});
    }
    {
        Geometry& geometry = begin("a cylinder seen end-on", front);
        add(geometry, cylinder({0, 0, -1}, {0, 0, 1}, 1, 2));
        add(geometry, cylinder({1, 0, -3}, {0, 0, 1}, 1, 1));
    }
    {
        Geometry& geometry = begin("cylinders seen from the side", front);
        add(geometry, cylinder({-1, -1, 0}, {0, 1, 0}, 0.7, 2));
        add(geometry, cylinder({1, -1, 0}, {0, 1, 0.001}, 0.7, 2));
        add(geometry, cylinder({0, 2, 0}, {1, 0.02, 0.02}, 0.3, 2));
    }
    {
        Geometry& geometry = begin("cones with the apex towards the viewer, and away", front);
        add(geometry, cone({-1, 0, 0}, {0, 0, 1}, 1, 2));
        add(geometry, cone({1, 0, 0}, {0, 0, -1}, 1, 2));
        add(geometry, cone({0, 1.5, 0}, {0.2, 0, 1}, 1, 2));
    }
    {
        Geometry& geometry = begin("a goblet of cylinders, cones and a ball on a block", above);
        add(geometry, cylinder({0, -1, 0}, {0, 1, 0}, 1, 0.1));
        add(geometry, cylinder({0, -0.9, 0}, {0, 1, 0}, 0.2, 1));
        add(geometry, cone({0, 1, 0}, {0, -1, 0}, 0.8, 1));
        add(geometry, Sphere{{0, 1.2, 0}, 0.5});
        add_polygon(geometry, {{-2, -1, 2}, {2, -1, 2}, {2, -1, -2}, {-2, -1, -2}});
    }
    for (NamedScene& named : all) {
        add_wall(named.scene.geometry, named.camera);
        number_primitives(named.scene);
    }
    return all;
}

TEST(DrawnBorders, AreSoundInDegenerateScenes) {
    for (const NamedScene& named : degenerate_scenes()) {
        // Has as many facets as there may be, whatever the deviation: once is enough.
        const bool is_costly = named.name == "a ball that reaches to the viewer";
        for (const FaceUnit unit : {FaceUnit::plane, FaceUnit::smooth})
            for (const double deviation :
                 unit == FaceUnit::plane ? std::vector{0.3, 2.0} : std::vector{0.1, 0.5, 2.0}) {
                if (is_costly && (unit == FaceUnit::plane || deviation != 0.5))
                    continue;
                const DrawnMap drawn = drawn_map(named.scene, named.camera, unit, deviation);
                expect_sound(
                    named.scene,
                    named.camera,
                    drawn,
                    named.name + ", " + std::to_string(static_cast<int>(unit)) + ", "
                        + std::to_string(deviation));
                if (HasFailure())
                    return;
            }
    }
}

Scene random_scene(std::mt19937_64& random, const Camera& camera, bool with_shapes) {
    const double values[] = {-2, -1, -0.5, 0, 0.5, 1, 1.5};
    const double sizes[] = {0.25, 0.5, 0.5, 1};
    const auto value = [&] { return values[random() % 7]; };
    const auto size = [&] { return sizes[random() % 4]; };
    Scene scene;
    const std::size_t count = 2 + random() % 6;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 at = {value(), value(), value()};
        const Vec3 axis = {value(), 1.1, value()};
        // Compilers differ in which argument comes first.
        const auto shape = [&](const auto& made) {
            const double last = size();
            const double first = size();
            return made(at, axis, first, last);
        };
        switch (with_shapes ? random() % 4 : 0) {
        case 1:
            add(scene.geometry, shape(cylinder));
            break;
        case 2:
            add(scene.geometry, shape(cone));
            break;
        case 3:
            add_polygon(
                scene.geometry, {at, at + Vec3{size(), 0, size()}, at + Vec3{0, size(), size()}});
            break;
        default:
            add(scene.geometry, Sphere{at, size()});
        }
    }
    add_wall(scene.geometry, camera);
    number_primitives(scene);
    return scene;
}

TEST(DrawnBorders, AreSoundInRandomScenes) {
    std::mt19937_64 random(1988);
    const Vec3 views[] = {{0, 0, -1}, {-0.3, -0.5, -1}, {0, -1, 0}, {1, 0.2, 0.3}};
    for (int i = 0; i < 60 && !HasFailure(); ++i) {
        const Camera camera = camera_towards(views[random() % 4], i % 2 == 0);
        const Scene scene = random_scene(random, camera, true);
        const FaceUnit unit = i % 3 == 0 ? FaceUnit::plane : FaceUnit::smooth;
        const DrawnMap drawn = drawn_map(scene, camera, unit, i % 4 < 2 ? 0.1 : 1);
        expect_sound(scene, camera, drawn, "scene " + std::to_string(i));
    }
}

/// Coarse facets, exact outlines: of balls that do not pass through each other.
TEST(DrawnBorders, OfBallsAreWhereRaysSaySoHoweverFewTheFacets) {
    std::mt19937_64 random(7);
    int compared = 0;
    int off = 0;
    for (int i = 0; i < 20; ++i) {
        const Camera camera = camera_towards({-0.3, -0.5, -1}, i % 2 == 0);
        Scene scene;
        // On a lattice, so that none pass through each other, but some touch.
        const double values[] = {-1, 0, 1};
        std::set<std::array<double, 3>> places;
        while (places.size() < 6)
            places.insert({values[random() % 3], values[random() % 3], values[random() % 3]});
        for (const auto& [x, y, z] : places)
            add(scene.geometry, Sphere{{x, y, z}, random() % 2 == 0 ? 0.5 : 0.35});
        add_wall(scene.geometry, camera);
        number_primitives(scene);
        const DrawnMap drawn = drawn_map(scene, camera, FaceUnit::smooth, 1);
        std::vector<std::vector<PointChain>> flat;
        for (const FilledOutline& outline : outlines(drawn, drawn.curved))
            flat.push_back(testing::flattened_rings(outline));
        const auto index = make_brute_force(scene);
        for (int j = 0; j < 5000; ++j) {
            const DrawingPoint at = {
                std::uniform_real_distribution(0.0, wide)(random),
                std::uniform_real_distribution(0.0, high)(random)};
            // Within the facets' deviation of an outline, where facets would be wrong, but not
            // upon it.
            constexpr double unit_per_pixel = 6 / wide;
            const double away = off_exact_outlines(scene.geometry, camera, at) / unit_per_pixel;
            if (away < 0.05 || away > 1)
                continue;
            QueryRay query;
            query.ray = view_ray(camera, at.x / wide, at.y / high);
            std::array<Hit, 1> hits;
            QueryCounts counts;
            index->nearest_hits(std::array{query}, hits, counts);
            ASSERT_TRUE(hits[0].found());
            ++compared;
            for (std::size_t region = 0; region < flat.size(); ++region) {
                const std::uint32_t source = drawn.map.regions[region].source;
                const bool is_seen = drawn.all.triangles[drawn.faces.first_facet[source]].primitive
                    == hits[0].face.primitive;
                off += (testing::turns_about(flat[region], at) != 0) != is_seen ? 1 : 0;
            }
        }
    }
    EXPECT_GT(compared, 1000);
    // Outlines that all but touch may cross farther from where facets do than corners move.
    EXPECT_LE(off, compared / 500);
}

TEST(DrawnBorders, OfABallAloneAreOneWholeEllipse) {
    for (const bool is_parallel : {false, true})
        for (const double deviation : {0.05, 0.5, 4.0}) {
            Scene scene;
            add(scene.geometry, Sphere{{0.3, 0.2, -0.4}, 1.3});
            number_primitives(scene);
            const Camera camera = camera_towards({-0.35, -0.5, -1}, is_parallel);
            const DrawnMap drawn = drawn_map(scene, camera, FaceUnit::smooth, deviation);
            std::size_t rings = 0;
            for (const FilledOutline& outline : outlines(drawn, drawn.curved)) {
                for (std::size_t i = 0; i < outline.rings.size(); ++i) {
                    ++rings;
                    EXPECT_EQ(outline.rings[i].size(), 1U) << deviation;
                    ASSERT_EQ(outline.arcs.at(i).size(), 1U);
                    const DrawingArc& arc = outline.arcs[i][0];
                    EXPECT_EQ(std::abs(arc.end_degrees - arc.begin_degrees), 360);
                }
            }
            EXPECT_EQ(rings, 1U) << is_parallel << ' ' << deviation;
        }
}

TEST(DrawnBorders, AreTheSameForAnyNumberOfThreads) {
    std::mt19937_64 random(3);
    const Camera camera = camera_towards({-0.3, -0.5, -1}, false);
    const Scene scene = random_scene(random, camera, true);
    const auto drawn = [&](std::size_t threads) {
        const ThreadLimit limit(threads);
        return drawn_map(scene, camera, FaceUnit::plane, 0.05).curved;
    };
    const DrawnBorders one = drawn(1);
    EXPECT_FALSE(one.curves.all().empty());
    for (const std::size_t threads : {2U, 7U}) {
        const DrawnBorders more = drawn(threads);
        EXPECT_EQ(more.places, one.places);
        EXPECT_EQ(more.side_curves, one.side_curves);
    }
}

TEST(AddRing, MakesOneArcOfSidesAlongACurveUpToANode) {
    const DrawingEllipse circle = {{10, 10}, {5, 0}, {0, 5}};
    const std::vector<DrawingEllipse> curves = {circle};
    const auto at = [&](double degrees, bool is_node = false) {
        return BorderPoint(point_at(circle, degrees), 0, is_node);
    };
    FilledOutline outline;
    // A slice, whose ring begins within its arc.
    add_ring(
        {at(30), at(60), at(90, true), at(120), {point_at(circle, 150)}, {10, 10}, at(0)},
        curves,
        outline);
    ASSERT_EQ(outline.rings.size(), 1U);
    EXPECT_EQ(outline.rings[0].size(), 4U);
    ASSERT_EQ(outline.arcs.size(), 1U);
    ASSERT_EQ(outline.arcs[0].size(), 2U);
    double sum = 0;
    for (const DrawingArc& arc : outline.arcs[0])
        sum += arc.end_degrees - arc.begin_degrees;
    EXPECT_NEAR(sum, 150, 1e-9);
    EXPECT_NEAR(area_of(outline), 25 * 3.14159265358979 * 150 / 360, 1e-9);

    // The whole of it in either direction, and to and fro, which is nothing.
    std::vector<BorderPoint> whole;
    for (int i = 0; i < 12; ++i)
        whole.push_back(at(77 + 30 * i));
    FilledOutline disc;
    add_ring(whole, curves, disc);
    EXPECT_NEAR(area_of(disc), 25 * 3.14159265358979, 1e-9);
    std::reverse(whole.begin(), whole.end());
    FilledOutline hole;
    add_ring(whole, curves, hole);
    EXPECT_NEAR(area_of(hole), -25 * 3.14159265358979, 1e-9);
    EXPECT_EQ(hole.rings, disc.rings);
    FilledOutline nothing;
    add_ring({at(0), at(30), at(60), at(30)}, curves, nothing);
    EXPECT_TRUE(nothing.rings.empty());

    // Where a chord was cut, the end moves to the arc.
    const DrawingPoint a = point_at(circle, 0);
    const DrawingPoint b = point_at(circle, 20);
    const DrawingPoint cut = {(a.x + b.x) / 2, (a.y + b.y) / 2};
    FilledOutline part;
    add_ring({{a, 0}, {cut}, {10, 10}}, curves, part);
    EXPECT_NEAR(distance(part.rings.at(0)[1], circle.center), 5, 1e-12);
    EXPECT_NEAR(part.arcs.at(0)[0].end_degrees, 10, 1e-9);
}

} // namespace
} // namespace vera
