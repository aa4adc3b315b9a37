// SPDX-License-Identifier: Apache-2.0
// That drawings of plane faces of meshes show what those of their triangles do, without what parts
// them.
#include "vera/accel/brute_force.h"
#include "vera/visible/draw_scene.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/map_locator.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/projection.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "visible/cameras.h"
#include "visible/plane_meshes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::below;
using testing::cube;
using testing::random_field;

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

TEST(DrawnPatches, AreWhereTheirTrianglesAre) {
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

TEST(DrawnPatches, OfACubeAreThreeAreasAndNineLines) {
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

TEST(DrawnPatches, HaveTheHiddenLinesOfPolygons) {
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
TEST(DrawnPatches, OfMeshesInSubscenesAndInShadowAreWhatRaysMeet) {
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
