// SPDX-License-Identifier: Apache-2.0
// Which triangles of meshes become one face of a drawing, compared with a search through all pairs
// in whole numbers; and that a drawing of such faces shows what one of the triangles does.
#include "vera/accel/brute_force.h"
#include "vera/base/parallel.h"
#include "vera/visible/coplanar_patches.h"
#include "vera/visible/draw_scene.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/map_locator.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/projection.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "visible/cameras.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using WholePoint = std::array<std::int64_t, 3>;

std::size_t below(std::mt19937& random, std::size_t count) {
    return random() % count;
}

/// Of a mesh whose coordinates are whole numbers.
class WholeTriangles {
public:
    explicit WholeTriangles(const Mesh& mesh)
        : mesh_(mesh) {}

    /// Whether they are neighbours in one plane, word by word.
    bool are_neighbours(std::size_t one, std::size_t other) const {
        return one != other && have_opposite_sides(one, other) && are_in_one_plane(one, other)
            && dot(normal(one), normal(other)) > 0 && have_one_normal(one, other);
    }

private:
    static WholePoint step(const WholePoint& a, const WholePoint& b) {
        return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    }

    static std::int64_t dot(const WholePoint& a, const WholePoint& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }

    std::uint32_t corner(std::size_t triangle, std::size_t i) const {
        return mesh_.position_indices[3 * triangle + i % 3];
    }

    WholePoint point(std::size_t triangle, std::size_t i) const {
        const Vec3 p = mesh_.positions[corner(triangle, i)];
        return {
            static_cast<std::int64_t>(p.x),
            static_cast<std::int64_t>(p.y),
            static_cast<std::int64_t>(p.z)};
    }

    WholePoint normal(std::size_t triangle) const {
        const WholePoint u = step(point(triangle, 0), point(triangle, 1));
        const WholePoint v = step(point(triangle, 0), point(triangle, 2));
        return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    }

    bool have_opposite_sides(std::size_t one, std::size_t other) const {
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k)
                if (corner(one, i) == corner(other, k + 1)
                    && corner(one, i + 1) == corner(other, k))
                    return true;
        return false;
    }

    bool are_in_one_plane(std::size_t one, std::size_t other) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (dot(normal(one), step(point(one, 0), point(other, k))) != 0)
                return false;
        return true;
    }

    bool have_one_normal(std::size_t one, std::size_t other) const {
        if (mesh_.normals.empty())
            return true;
        const auto of = [&](std::size_t triangle, std::size_t i) {
            return mesh_.normals[mesh_.normal_indices[3 * triangle + i]];
        };
        for (const std::size_t triangle : {one, other})
            for (std::size_t i = 0; i < 3; ++i)
                if (of(triangle, i) != of(one, 0))
                    return false;
        return true;
    }

    const Mesh& mesh_;
};

/// Passes the smallest number on between neighbours until nothing changes.
std::vector<std::uint32_t> patches_by_all_pairs(const Mesh& mesh) {
    const WholeTriangles triangles(mesh);
    std::vector<std::uint32_t> first(mesh.triangle_count());
    std::iota(first.begin(), first.end(), 0U);
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t one = 0; one < first.size(); ++one)
            for (std::size_t other = 0; other < first.size(); ++other)
                if (first[one] < first[other] && triangles.are_neighbours(one, other)) {
                    first[other] = first[one];
                    changed = true;
                }
    }
    return first;
}

/// With each by itself where the patches are none.
std::vector<std::uint32_t> all_firsts(const Mesh& mesh) {
    std::vector<std::uint32_t> first = coplanar_patches(mesh);
    if (first.empty()) {
        first.resize(mesh.triangle_count());
        std::iota(first.begin(), first.end(), 0U);
    }
    return first;
}

std::size_t count_patches(const std::vector<std::uint32_t>& first) {
    return std::set<std::uint32_t>(first.begin(), first.end()).size();
}

void add_triangle(Mesh& mesh, std::array<std::size_t, 3> corners) {
    for (const std::size_t corner : corners)
        mesh.position_indices.push_back(static_cast<std::uint32_t>(corner));
}

/// A field of squares of two triangles each, at heights of few values, some squares twice, turned
/// over or without an area.
Mesh random_field(std::mt19937& random, std::size_t side, std::size_t heights) {
    Mesh mesh;
    for (std::size_t y = 0; y <= side; ++y)
        for (std::size_t x = 0; x <= side; ++x)
            mesh.positions.push_back(
                {static_cast<double>(x),
                 static_cast<double>(y),
                 static_cast<double>(below(random, heights))});
    for (std::size_t y = 0; y < side; ++y)
        for (std::size_t x = 0; x < side; ++x) {
            const std::size_t a = y * (side + 1) + x;
            const std::array<std::size_t, 4> round = {a, a + 1, a + side + 2, a + side + 1};
            const std::size_t from = below(random, 2);
            const auto corner = [&](std::size_t i) { return round[(from + i) % 4]; };
            const std::size_t kind = below(random, 12);
            add_triangle(mesh, {corner(0), corner(1), corner(2)});
            if (kind == 0)
                add_triangle(mesh, {corner(0), corner(3), corner(2)});
            else
                add_triangle(mesh, {corner(0), corner(2), corner(3)});
            if (kind == 1)
                add_triangle(mesh, {corner(2), corner(3), corner(0)});
            if (kind == 2)
                add_triangle(mesh, {corner(0), corner(2), corner(0)});
        }
    return mesh;
}

/// Triangles between any of few points.
Mesh random_tangle(std::mt19937& random) {
    Mesh mesh;
    for (std::size_t i = 0; i < 7; ++i) {
        Vec3 point;
        for (double* const coordinate : {&point.x, &point.y, &point.z})
            *coordinate = static_cast<double>(below(random, 3));
        mesh.positions.push_back(point);
    }
    for (std::size_t i = 0; i < 14; ++i) {
        std::array<std::size_t, 3> corners = {};
        for (std::size_t& corner : corners)
            corner = below(random, mesh.positions.size());
        add_triangle(mesh, corners);
    }
    return mesh;
}

void add_normals(std::mt19937& random, Mesh& mesh) {
    mesh.normals = {{0, 0, 1}, {0, 0.6, 0.8}, {0, 0, 1}};
    for (std::size_t i = 0; i < mesh.position_indices.size(); ++i)
        mesh.normal_indices.push_back(below(random, 12) == 0 ? 1 : below(random, 2) == 0 ? 0 : 2);
}

TEST(CoplanarPatches, AreThoseOfASearchThroughAllPairs) {
    std::mt19937 random(57);
    std::size_t joined = 0;
    std::size_t apart = 0;
    for (std::size_t round = 0; round < 300; ++round) {
        Mesh mesh = round % 3 == 0 ? random_tangle(random)
                                   : random_field(random, 1 + below(random, 5), 1 + round % 3);
        if (round % 4 == 1)
            add_normals(random, mesh);
        const std::vector<std::uint32_t> expected = patches_by_all_pairs(mesh);
        ASSERT_EQ(all_firsts(mesh), expected) << "round " << round;
        joined += expected.size() - count_patches(expected);
        apart += count_patches(expected);
    }
    EXPECT_GT(joined, 1000U);
    EXPECT_GT(apart, 1000U);
}

TEST(CoplanarPatches, AreTheSameForAnyNumberOfThreads) {
    std::mt19937 random(3);
    const Mesh mesh = random_field(random, 120, 2); // vertices for several threads
    std::vector<std::uint32_t> one;
    for (const std::size_t threads : {1U, 2U, 7U}) {
        const ThreadLimit limit(threads);
        const std::vector<std::uint32_t> first = coplanar_patches(mesh);
        if (threads == 1)
            one = first;
        EXPECT_EQ(first, one);
    }
    EXPECT_GT(mesh.triangle_count(), count_patches(one) + 1000);
}

/// Two triangles with the side from (0, 0, 0) to (1, 1, 0).
Mesh two_triangles(double height) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, height}};
    mesh.position_indices = {0, 2, 1, 0, 1, 3};
    return mesh;
}

TEST(CoplanarPatches, TellTheSmallestAngleFromNone) {
    EXPECT_EQ(coplanar_patches(two_triangles(0)), (std::vector<std::uint32_t>{0, 0}));
    EXPECT_TRUE(coplanar_patches(two_triangles(1e-300)).empty());
}

TEST(CoplanarPatches, OfMoreThanMayHaveASideInCommonAreNone) {
    const auto copies = [](std::size_t count) {
        Mesh mesh = two_triangles(0);
        for (std::size_t i = 1; i < count; ++i)
            mesh.position_indices.insert(mesh.position_indices.end(), {0, 2, 1, 0, 1, 3});
        return coplanar_patches(mesh);
    };
    EXPECT_EQ(copies(64), std::vector<std::uint32_t>(128, 0));
    EXPECT_TRUE(copies(65).empty());
}

/// A fan of many triangles round one vertex takes no time that grows with their square.
TEST(CoplanarPatches, OfAWideFanAreOne) {
    constexpr std::uint32_t count = 50000;
    Mesh mesh;
    mesh.positions.push_back({0, 0, 0});
    for (std::uint32_t i = 0; i <= count; ++i)
        mesh.positions.push_back({1, static_cast<double>(i), 0});
    for (std::uint32_t i = 1; i <= count; ++i)
        mesh.position_indices.insert(mesh.position_indices.end(), {0, i, i + 1});
    EXPECT_EQ(coplanar_patches(mesh), std::vector<std::uint32_t>(count, 0));
}

/// The mesh in the main scene, and, where it is called as well, turned over by a mirror beside it.
Scene scene_of(Mesh mesh, bool is_called) {
    Scene scene;
    scene.lights = {{.position = {3, 4, 20}}};
    Item item;
    item.kind = ItemKind::mesh;
    if (is_called) {
        Geometry& geometry = scene.subscenes.emplace_back();
        geometry.meshes = {mesh};
        geometry.items = {item};
        SubsceneCall call;
        for (std::size_t axis = 0; axis < 3; ++axis)
            call.to_parent.linear.rows[axis] = call.from_parent.linear.rows[axis] = axis == 0
                ? Vec3{-1, 0, 0}
                : axis == 1 ? Vec3{0, 1, 0}
                            : Vec3{0, 0, 1};
        scene.geometry.calls = {call};
    }
    scene.geometry.meshes = {std::move(mesh)};
    scene.geometry.items = {item};
    if (is_called)
        scene.geometry.items.emplace_back().kind = ItemKind::subscene_call;
    number_primitives(scene);
    return scene;
}

/// A map of what is seen of a scene in faces of a unit.
struct FaceMap {
    FaceMap(const Scene& scene, const Camera& camera, FaceUnit unit)
        : all(facets(scene, [](Vec3) { return 1.0; }))
        , faces(drawn_faces(scene, all, unit, camera)) {
        const DrawnFaces planes = drawn_faces(scene, all, FaceUnit::plane, camera);
        ScreenScene screen = screen_scene(all, CameraMap(camera), planes.of_facet);
        sort_by_place(screen);
        VisiblePieces pieces = whole_pieces(screen).pieces;
        join_sources(screen, pieces, planes, faces);
        map = visible_map(screen, pieces);
    }

    std::map<std::uint32_t, double> areas_of_faces() const {
        std::map<std::uint32_t, double> areas;
        for (const VisibleMap::Ring& ring : map.rings)
            areas[ring.source] += doubled_area(map, ring);
        return areas;
    }

    Facets all;
    DrawnFaces faces;
    VisibleMap map;
};

TEST(CoplanarPatches, AreDrawnWhereTheirTrianglesAre) {
    std::mt19937 random(8);
    std::size_t fewer = 0;
    for (int round = 0; round < 24; ++round) {
        Mesh mesh = random_field(random, 3 + below(random, 4), 2);
        for (Vec3& point : mesh.positions)
            point = point - Vec3{2, 2, 0.5};
        const Scene scene = scene_of(std::move(mesh), round % 2 == 1);
        const Camera camera = testing::camera_number(round);
        const FaceMap apart(scene, camera, FaceUnit::plane);
        const FaceMap joined(scene, camera, FaceUnit::flat);
        const auto face_of = [&](std::uint32_t source) {
            return joined.faces.of_facet[apart.faces.first_facet[source]];
        };
        fewer += apart.map.regions.size() - joined.map.regions.size();
        // Each as large as its triangles, and where they are.
        std::map<std::uint32_t, double> areas;
        for (const auto& [source, area] : apart.areas_of_faces())
            areas[face_of(source)] += area;
        for (const auto& [source, area] : joined.areas_of_faces()) {
            EXPECT_NEAR(area, areas[source], 1e-6 * screen_size * screen_size) << round;
            areas.erase(source);
        }
        EXPECT_TRUE(areas.empty()) << round;
        const MapLocator places(apart.map);
        const MapLocator joined_places(joined.map);
        for (int i = 0; i < 500; ++i) {
            const double x = static_cast<double>(below(random, 1U << 20U)) * 4 + 0.3;
            const double y = static_cast<double>(below(random, 1U << 20U)) * 4 + 0.7;
            const std::uint32_t source = places.at(x, y).source;
            const MapPlace place = joined_places.at(x, y);
            EXPECT_TRUE(place.is_sound);
            ASSERT_EQ(place.source, source == no_source ? no_source : face_of(source))
                << "round " << round << " at " << x << ' ' << y;
        }
        // And nothing parts them.
        for (const VisibleMap::Ring& ring : joined.map.rings)
            for (std::size_t i = 0; i < ring.count; ++i)
                EXPECT_NE(joined.map.source_across(ring.first + i), ring.source);
    }
    EXPECT_GT(fewer, 100U);
}

/// Twelve triangles.
Mesh cube() {
    Mesh mesh;
    for (std::size_t i = 0; i < 8; ++i)
        mesh.positions.push_back(
            {(i & 4U) == 0 ? -1.0 : 1.0, (i & 2U) == 0 ? -1.0 : 1.0, (i & 1U) == 0 ? -1.0 : 1.0});
    const std::array<std::array<std::size_t, 4>, 6> sides = {
        {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}};
    for (const auto& [a, b, c, d] : sides) {
        add_triangle(mesh, {a, b, c});
        add_triangle(mesh, {a, c, d});
    }
    return mesh;
}

struct Picture {
    explicit Picture(Scene shown)
        : scene(std::move(shown)) {
        camera.viewpoint = {5, 3, 4};
        const Vec3 to = normalized(-camera.viewpoint);
        const Vec3 across = normalized(cross(to, {0, 0, 1}));
        const Vec3 up = cross(across, to);
        camera.lower_left = -2.0 * across - 2.0 * up;
        camera.lower_right = 2.0 * across - 2.0 * up;
        camera.upper_left = -2.0 * across + 2.0 * up;
        settings.width = settings.height = 200;
    }

    DrawnScene draw(DrawSettings how) const { return draw_scene(scene, camera, settings, how); }

    Scene scene;
    Camera camera;
    PictureSettings settings;
};

TEST(CoplanarPatches, OfACubeAreThreeAreasAndNineLines) {
    const Picture picture(scene_of(cube(), false));
    for (const DrawingStyle style :
         {DrawingStyle::flat, DrawingStyle::shaded, DrawingStyle::toon, DrawingStyle::ids}) {
        DrawSettings settings;
        settings.style = style;
        const DrawnScene drawn = picture.draw(settings);
        std::set<std::string> ids;
        for (const FilledOutline& fill : drawn.drawing.fills)
            if (fill.id.starts_with("face-"))
                ids.insert(fill.id);
        if (style == DrawingStyle::ids)
            EXPECT_EQ(drawn.drawing.areas.count(), 6U);
        else
            EXPECT_EQ(ids, (std::set<std::string>{"face-3", "face-7", "face-11"}));
        EXPECT_EQ(drawn.visible_faces, style == DrawingStyle::ids ? 6U : 3U);
    }
    std::map<LineClass, std::size_t> segments;
    DrawSettings settings;
    settings.style = DrawingStyle::hidden_lines;
    for (const Stroke& stroke : picture.draw(settings).drawing.strokes)
        segments[stroke.line_class] += stroke.points.size() - (stroke.closed ? 0 : 1);
    EXPECT_EQ(
        segments,
        (std::map<LineClass, std::size_t>{
            {LineClass::hidden, 3}, {LineClass::crease, 3}, {LineClass::silhouette, 6}}));
}

/// A cube, and a blade that passes through its far side.
std::vector<std::vector<Vec3>> sides_of_cube_and_blade() {
    std::vector<std::vector<Vec3>> sides;
    const Mesh mesh = cube();
    for (std::size_t i = 0; i < 6; ++i) {
        const auto corner = [&](std::size_t k) {
            return mesh.positions[mesh.position_indices[6 * i + k]];
        };
        sides.push_back({corner(0), corner(1), corner(2), corner(5)});
    }
    sides.push_back({{-1.8, 0.1, -0.4}, {-0.5, 0.1, -0.4}, {-0.5, 0.1, 0.4}, {-1.8, 0.1, 0.4}});
    return sides;
}

/// Of each class, in pixels.
std::map<LineClass, double> lengths_of_lines(const Scene& scene) {
    std::map<LineClass, double> lengths;
    DrawSettings settings;
    settings.style = DrawingStyle::hidden_lines;
    for (const Stroke& stroke : Picture(scene).draw(settings).drawing.strokes)
        for (std::size_t i = stroke.closed ? 0 : 1; i < stroke.points.size(); ++i) {
            const DrawingPoint a = stroke.points[i == 0 ? stroke.points.size() - 1 : i - 1];
            lengths[stroke.line_class] +=
                std::hypot(stroke.points[i].x - a.x, stroke.points[i].y - a.y);
        }
    return lengths;
}

TEST(CoplanarPatches, HaveTheHiddenLinesOfPolygons) {
    Scene of_polygons;
    Scene of_meshes;
    for (const std::vector<Vec3>& side : sides_of_cube_and_blade()) {
        const auto index = static_cast<std::uint32_t>(of_polygons.geometry.polygons.size());
        Polygon& polygon = of_polygons.geometry.polygons.emplace_back();
        polygon.first_corner = static_cast<std::uint32_t>(of_polygons.geometry.corners.size());
        polygon.corner_count = 4;
        polygon.normal = normalized(cross(side[1] - side[0], side[2] - side[0]));
        for (const Vec3& corner : side)
            of_polygons.geometry.corners.push_back(corner);
        Mesh& mesh = of_meshes.geometry.meshes.emplace_back();
        mesh.positions = side;
        mesh.position_indices = {0, 1, 2, 0, 2, 3};
        for (Scene* const scene : {&of_polygons, &of_meshes}) {
            Item& item = scene->geometry.items.emplace_back();
            item.kind = scene == &of_meshes ? ItemKind::mesh : ItemKind::polygon;
            item.index = index;
        }
    }
    number_primitives(of_polygons);
    number_primitives(of_meshes);
    const std::map<LineClass, double> expected = lengths_of_lines(of_polygons);
    const std::map<LineClass, double> lengths = lengths_of_lines(of_meshes);
    ASSERT_EQ(lengths.size(), expected.size());
    for (const auto& [line_class, length] : expected)
        EXPECT_NEAR(lengths.at(line_class), length, 0.05) << static_cast<int>(line_class);
    EXPECT_GT(expected.at(LineClass::hidden), 300);
}

/// Where one primitive of a face is drawn, a ray meets another one of it.
TEST(CoplanarPatches, OfMeshesInSubscenesAndInShadowAreWhatRaysMeet) {
    Mesh mesh = cube();
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    for (const double x : {-0.5, 0.4}) // a blade that throws its shadow on two triangles of a side
        for (const double y : {-0.5, 0.5})
            mesh.positions.push_back({x, y, 1.5});
    for (const std::uint32_t corner : {0U, 1U, 2U, 2U, 1U, 3U})
        mesh.position_indices.push_back(count + corner);
    const Picture picture(scene_of(std::move(mesh), true));
    const auto index = make_brute_force(picture.scene);
    for (const DrawingStyle style : {DrawingStyle::flat, DrawingStyle::shaded}) {
        DrawSettings settings;
        settings.style = style;
        std::size_t points = 0;
        settings.check = [&](const PrimitiveMap& map, const Progress&) {
            const MapCheck check = check_map(
                map, picture.scene, picture.camera, *index, {3000, 200, 200, settings.deviation});
            EXPECT_EQ(check.far, 0U);
            EXPECT_LT(check.near, 60U);
            EXPECT_FALSE(map.joined.empty());
            points += check.points;
        };
        EXPECT_GT(picture.draw(settings).shadows.partly_lit, 0U);
        EXPECT_EQ(points, 3000U);
    }
}

} // namespace
} // namespace vera
