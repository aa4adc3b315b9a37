// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/nff_mapping.h"
#include "vera/math/elementary.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "formats/mesh_text.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::HasSubstr;

const std::string view =
    "v\nfrom 0 -5 0\nat 0 0 0\nup 0 0 1\nangle 90\nhither 1\nresolution 64 32\n";
const std::string fill = "f 1 0.5 0.25 0.8 0.2 20 0.5 1.5\n";

Scene scene_of(const std::string& text) {
    return read_nff(SourceText("test.nff", text)).scene;
}

void expect_near(Vec3 point, Vec3 expected) {
    EXPECT_NEAR(length(point - expected), 0, 1e-12) << point.x << ' ' << point.y << ' ' << point.z;
}

TEST(ReadNff, MakesTheViewACamera) {
    const Scene scene = scene_of(view + fill + "s 0 0 0 1\n");
    ASSERT_TRUE(scene.camera);
    EXPECT_EQ(scene.camera->projection, Camera::Projection::perspective);
    expect_near(scene.camera->viewpoint, {0, -5, 0});
    // 90 degrees across a distance of 5; half as high as wide.
    expect_near(scene.camera->lower_left, {-5, 0, -2.5});
    expect_near(scene.camera->lower_right, {5, 0, -2.5});
    expect_near(scene.camera->upper_left, {-5, 0, 2.5});
    EXPECT_EQ(scene.defaults.width, 64U);
    EXPECT_EQ(scene.defaults.height, 32U);
}

TEST(ReadNff, HasItsOwnSettings) {
    const Scene scene = scene_of("b 0.1 0.2 0.3\n" + view + fill + "s 0 0 0 1\n");
    EXPECT_EQ(scene.defaults.depth, 5U);
    EXPECT_TRUE(scene.defaults.shadows);
    EXPECT_TRUE(is_black(scene.defaults.ambient));
    ASSERT_TRUE(scene.defaults.firmament);
    const Color background = {0.1, 0.2, 0.3};
    EXPECT_EQ(scene.defaults.firmament->sky, background);
    EXPECT_EQ(scene.defaults.firmament->horizon, background);
    EXPECT_EQ(scene.defaults.firmament->earth, background);
    EXPECT_FALSE(scene_of(view + fill + "s 0 0 0 1\n").defaults.firmament);
    EXPECT_FALSE(scene_of(fill + "s 0 0 0 1\n").camera) << "to be framed automatically";
}

TEST(ReadNff, DividesTheLightAmongLightsWithoutColour) {
    const Scene scene =
        scene_of(fill + "l 1 2 3\nl 4 5 6 1 0.5 0\ns 0 0 0 1\nl 7 8 9 # last\nl 0 0 9\n");
    ASSERT_EQ(scene.lights.size(), 4U);
    for (const PointLight& light : scene.lights)
        EXPECT_EQ(light.falloff, Falloff::none);
    EXPECT_EQ(scene.lights[0].position, (Vec3{1, 2, 3}));
    EXPECT_EQ(scene.lights[0].intensity, 0.5);
    EXPECT_EQ(scene.lights[0].color, (Color{1, 1, 1}));
    EXPECT_EQ(scene.lights[1].intensity, 1);
    EXPECT_EQ(scene.lights[1].color, (Color{1, 0.5, 0}));
    EXPECT_EQ(scene.lights[3].intensity, 0.5);
}

TEST(ReadNff, MakesFillsMaterials) {
    const Scene scene = scene_of(
        fill + "s 0 0 0 1\nf 1 1 1 1 0 3 0 0\ns 1 0 0 1\n" + fill + "s 2 0 0 1\ns 3 0 0 1\n");
    ASSERT_EQ(scene.materials.size(), 2U) << "equal ones are shared";
    const Material& first = scene.materials[0];
    EXPECT_EQ(first.name, "f1");
    EXPECT_EQ(first.drf, (Color{0.8, 0.4, 0.2}));
    EXPECT_EQ(first.rab, (Color{0.2, 0.2, 0.2}));
    EXPECT_EQ(first.tab, (Color{0.5, 0.5, 0.5}));
    EXPECT_EQ(first.ref, 1.5);
    EXPECT_EQ(first.spc, spc_of(20));
    EXPECT_TRUE(is_black(first.arf));
    EXPECT_EQ(scene.materials[1].name, "f2");
    EXPECT_EQ(scene.materials[1].ref, 1) << "where it does not matter";
    EXPECT_EQ(scene.materials[1].spc, 1) << "no highlight without Ks";
    const auto material = [&](std::size_t item) {
        return static_cast<std::size_t>(scene.geometry.items[item].material);
    };
    EXPECT_EQ(material(0), 0U);
    EXPECT_EQ(material(1), 1U);
    EXPECT_EQ(material(2), 0U);
    EXPECT_EQ(material(3), 0U);
}

TEST(SpcOf, HalvesTheHighlightWhereTheCosinesPowerDoes) {
    for (const double shine : {0.5, 1.0, 3.0, 20.0, 1000.0, 100000.0}) {
        const double spc = spc_of(shine);
        const double x = std::pow(2, -1 / shine);
        const double f = (x - spc) * (x + spc - 2) / ((1 - spc) * (1 - spc));
        EXPECT_NEAR(f * f, 0.5, 1e-9) << shine;
        EXPECT_GE(spc, -1);
        EXPECT_LT(spc, 1);
    }
    EXPECT_EQ(spc_of(0), 1);
    EXPECT_EQ(spc_of(-5), 1);
    EXPECT_LE(spc_of(1e300), 1);
    EXPECT_GE(spc_of(1e-300), -1);
}

TEST(ReadNff, ReadsSpheres) {
    const Scene scene = scene_of(fill + "s 1 2 3 4\ns 1 2 3 -4\n");
    ASSERT_EQ(scene.geometry.spheres.size(), 2U);
    EXPECT_EQ(scene.geometry.spheres[0].center, (Vec3{1, 2, 3}));
    EXPECT_EQ(scene.geometry.spheres[0].radius, 4);
    EXPECT_EQ(scene.geometry.spheres[1].radius, 4);
}

TEST(ReadNff, MakesConesRotationalShapes) {
    const Scene scene = scene_of(fill + "c 1 0 0 2 1 0 5 0.5\nc 0 0 0 -1\n 0 0 2 -3\n");
    ASSERT_EQ(scene.geometry.rotational_shapes.size(), 2U);
    const RotationalShape& cone = scene.geometry.rotational_shapes[0];
    EXPECT_EQ(cone.base, (Vec3{1, 0, 0}));
    EXPECT_EQ(cone.axis, (Vec3{0, 0, 1}));
    EXPECT_EQ(cone.start, (ContourPiece::Point{2, 0}));
    ASSERT_EQ(cone.contour.size(), 1U) << "open at both ends";
    EXPECT_EQ(cone.contour[0].kind, ContourPiece::Kind::line);
    EXPECT_EQ(cone.contour[0].end, (ContourPiece::Point{0.5, 5}));
    // Negative radii turn the outside in: the contour runs the other way.
    const RotationalShape& inner = scene.geometry.rotational_shapes[1];
    EXPECT_EQ(inner.start, (ContourPiece::Point{3, 2}));
    EXPECT_EQ(inner.contour[0].end, (ContourPiece::Point{1, 0}));
}

TEST(ReadNff, MakesPolygonsTrianglesAndPolygons) {
    const Scene scene = scene_of(
        fill
        + "p 3\n0 0 0\n1 0 0\n0 1 0\np 4\n0 0 0\n0 1 0\n0 1 1\n0 0 1\n"
          "p 5\n0 0 0\n4 0 0\n4 4 0\n2 1 0\n0 4 0\n");
    const Geometry& geometry = scene.geometry;
    ASSERT_EQ(geometry.triangles.size(), 1U);
    EXPECT_EQ(geometry.triangles[0].corners[1], (Vec3{1, 0, 0}));
    ASSERT_EQ(geometry.polygons.size(), 2U);
    EXPECT_EQ(geometry.polygons[0].shape, Polygon::Shape::convex);
    EXPECT_EQ(geometry.polygons[0].normal, (Vec3{1, 0, 0}));
    EXPECT_EQ(geometry.polygons[1].shape, Polygon::Shape::simple);
    EXPECT_EQ(geometry.polygons[1].first_corner, 4U);
    EXPECT_EQ(geometry.polygons[1].corner_count, 5U);
    EXPECT_EQ(geometry.corners[7], (Vec3{2, 1, 0}));
    ASSERT_EQ(geometry.items.size(), 3U);
    EXPECT_EQ(geometry.items[0].kind, ItemKind::triangle);
    EXPECT_EQ(geometry.items[2].kind, ItemKind::polygon);
    EXPECT_EQ(geometry.items[2].index, 1U);
    EXPECT_EQ(geometry.items[2].outside, Outside::by_normal);
}

TEST(ReadNff, MakesPatchesOfPolygonsWithNormals) {
    const Scene scene =
        scene_of(fill + "pp 4\n0 0 0 0 0 1\n1 0 0 0 1 1\n1 1 0 1 0 1\n0 1 0 1 1 1\n");
    ASSERT_EQ(scene.geometry.patches.size(), 2U);
    const Patch& second = scene.geometry.patches[1];
    EXPECT_EQ(second.corners[1], (Vec3{1, 1, 0}));
    EXPECT_EQ(second.normals[1], (Vec3{1, 0, 1}));
    EXPECT_EQ(second.normals[2], (Vec3{1, 1, 1}));
}

TEST(ReadNff, KnowsTheLineOfEveryItem) {
    const Scene scene =
        scene_of("# a comment\n" + fill + "s 0 0 0 1\n\np 3\n0 0 0\n1 0 0\n0 1 0\ns 1 1 1 1");
    ASSERT_EQ(scene.geometry.items.size(), 3U);
    EXPECT_EQ(scene.files, (std::vector<std::string>{"test.nff"}));
    EXPECT_EQ(scene.geometry.items[0].line, 3U);
    EXPECT_EQ(scene.geometry.items[1].line, 5U);
    EXPECT_EQ(scene.geometry.items[2].line, 9U);
    EXPECT_EQ(scene.geometry.primitive_count, 3U);
}

TEST(ReadNff, LeavesOutWhatHasNoArea) {
    EXPECT_EQ(
        said_of_nff(
            fill
            + "s 0 0 0 0\nc 0 0 0 1 0 0 0 1\nc 0 0 0 0 0 0 1 0\np 2\n0 0 0\n1 0 0\n"
              "p 3\n0 0 0\n1 1 1\n2 2 2\npp 3\n0 0 0 0 0 1\n0 0 0 0 0 1\n1 0 0 0 0 1\ns 0 0 0 1\n"),
        "test.nff:2:1: warning: what has no area is left out (6 times, the first of them here)\n"
        "    s 0 0 0 0\n"
        "    ^\n");
}

TEST(ReadNff, SplitsPolygonsThatAreNotPlane) {
    const std::string bent = fill + "p 4\n0 0 0\n1 0 0\n1 1 1\n0 1 0\n";
    EXPECT_EQ(scene_of(bent).geometry.triangles.size(), 2U);
    EXPECT_EQ(
        said_of_nff(bent),
        "test.nff:2:1: warning: the corners of a polygon are not in a plane: it is split into "
        "triangles\n"
        "    p 4\n"
        "    ^\n");
    const std::string crossed = fill + "p 4\n0 0 0\n2 2 0\n2 0 0\n0 1 0\n";
    EXPECT_FALSE(scene_of(crossed).geometry.triangles.empty());
    EXPECT_THAT(
        said_of_nff(crossed),
        HasSubstr("test.nff:2:1: warning: the sides of a polygon cross: it is split as well as may "
                  "be\n"));
}

TEST(ReadNff, WarnsOfMissingSurfacesAndIndices) {
    EXPECT_EQ(
        said_of_nff("s 0 0 0 1\n"),
        "test.nff:1:1: warning: nothing says what the surface is like: DRF 0.7 0.7 0.7 is used\n"
        "    s 0 0 0 1\n"
        "    ^\n"
        "  write a statement f above it\n");
    EXPECT_THAT(
        said_of_nff("f 1 1 1 1 1 1 0.5 0\ns 0 0 0 1\n"),
        HasSubstr("test.nff:1:1: warning: a transparent surface has no index of refraction: 1 is "
                  "used\n"));
}

TEST(ReadNff, SaysWhereItIsWrongAndReadsOn) {
    EXPECT_EQ(
        said_of_nff("k 3\ns 0 0 0\nf 1 1 1\ns a 0 0 1\np 3\n0 0 0\n1 0 x\n2 2 2\nl 1 2 3 4\n"
                    "s 0 0 1e999 1\np 2.5\n"),
        "test.nff:1:1: error: expected a statement: v, b, l, f, c, s, p or pp, found 'k'\n"
        "    k 3\n"
        "    ^\n"
        "  the Neutral File Format of the Standard Procedural Databases is read here, without its "
        "extensions\n"
        "test.nff:3:1: error: expected the sphere's radius, found 'f'\n"
        "    f 1 1 1\n"
        "    ^\n"
        "test.nff:4:3: error: expected the x of the sphere's center, found 'a'\n"
        "    s a 0 0 1\n"
        "      ^\n"
        "test.nff:7:5: error: expected the z of the corner, found 'x'\n"
        "    1 0 x\n"
        "        ^\n"
        "test.nff:10:1: error: expected the green of the light, found 's'\n"
        "    s 0 0 1e999 1\n"
        "    ^\n"
        "test.nff:11:3: error: the number of corners must be a whole number, 3 or more\n"
        "    p 2.5\n"
        "      ^~~\n");
}

TEST(ReadNff, RefusesViewsThatShowNothing) {
    const auto said = [](const std::string& from, const std::string& to) {
        std::string text = view + fill + "s 0 0 0 1\n";
        text.replace(text.find(from), from.size(), to);
        return said_of_nff(text);
    };
    const std::string degenerate =
        "test.nff:1:1: error: the view is degenerate\n"
        "    v\n"
        "    ^\n"
        "  'from' and 'at' must differ, 'up' must not be parallel to the way from one to the "
        "other, and the angle lie between 0 and 180 degrees\n";
    EXPECT_EQ(said("from 0 -5 0", "from 0 0 0"), degenerate);
    EXPECT_EQ(said("up 0 0 1", "up 0 1 0"), degenerate);
    EXPECT_EQ(said("angle 90", "angle 180"), degenerate);
    EXPECT_EQ(said("angle 90", "angle 0"), degenerate);
    EXPECT_EQ(
        said("up 0 0 1\n", ""),
        "test.nff:1:1: error: the view lacks 'up'\n"
        "    v\n"
        "    ^\n"
        "  a view says: v from x y z at x y z up x y z angle a hither h resolution w h\n");
    EXPECT_THAT(
        said("resolution 64 32", "resolution 64 0"),
        HasSubstr("test.nff:7:15: error: the height of the resolution must be a whole number from "
                  "1 to 2147483648\n"));
    EXPECT_THAT(
        said_of_nff(view + view), HasSubstr("test.nff:8:1: error: the view is given twice\n"));
    EXPECT_THAT(
        said_of_nff("b 0 0 0\nb 0 0 0\n"),
        HasSubstr("test.nff:2:1: error: the background is given twice\n"));
}

TEST(ReadNff, RefusesAFileWithNothingInIt) {
    EXPECT_EQ(
        said_of_nff("# nothing\n"),
        "test.nff:2:1: error: the scene holds nothing to be seen\n"
        "  an NFF scene consists of the statements v, b, l, f, c, s, p and pp\n");
}

TEST(ReadNff, SaysOfEveryTruncatedFileThatItIsWrongOrReadsWhatIsThere) {
    const std::string whole = "b 0 0 0\n" + view + "l 1 2 3\n" + fill
        + "c 0 0 0 1 0 0 1 1\npp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\np 3\n0 0 0\n1 0 0\n0 1 "
          "0";
    for (std::size_t size = 0; size < whole.find("c 0 0 0 1 0 0 1 "); ++size)
        ASSERT_THAT(said_of_nff(whole.substr(0, size)), HasSubstr("error: ")) << size;
    for (std::size_t size = whole.size() - 20; size + 1 < whole.size(); ++size)
        ASSERT_THAT(said_of_nff(whole.substr(0, size)), HasSubstr("error: ")) << size;
}

TEST(ReadNff, ReadsTheStandardProceduralDatabases) {
    const char* const variable = std::getenv("VERA_SCENES");
    const std::filesystem::path folder =
        std::filesystem::path(variable != nullptr ? variable : VERA_SOURCE_DIR "/../shared/scenes")
        / "spd";
    const std::pair<const char*, std::size_t> scenes[] = {
        {"balls_4.nff", 7382},
        {"gears_4.nff", 9345},
        {"jacks_4.nff", 5265},
        {"lattice_12.nff", 8281},
        {"mount_6.nff", 8196},
        {"rings_7.nff", 8401},
        {"shells_5.nff", 5761},
        {"teapot_12.nff", 9264},
        {"tetra_6.nff", 4096},
        {"tree_11.nff", 8191}};
    if (!std::filesystem::exists(folder / scenes[0].first))
        GTEST_SKIP() << "no scenes at '" << folder.string()
                     << "': set VERA_SCENES to have them read";
    for (const auto& [name, items] : scenes) {
        const SceneFile file = read_nff(SourceText(folder / name));
        EXPECT_EQ(file.scene.geometry.items.size(), items) << name;
        EXPECT_EQ(printed(file.warnings), "") << name;
    }
}

} // namespace
} // namespace vera
