// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/read_scene.h"

#include "formats/read_text.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {

namespace {

using testing::ElementsAre;
using testing::SizeIs;

std::vector<ItemKind> kinds(const Geometry& geometry) {
    std::vector<ItemKind> result;
    for (const Item& item : geometry.items)
        result.push_back(item.kind);
    return result;
}

TEST(VeraScene, ReadsTheStillLifeOfThePaper) {
    const SceneFile file = read_scene(VERA_SOURCE_DIR "/scenes/still_life.vera");
    const Scene& scene = file.scene;
    ASSERT_TRUE(scene.camera);
    EXPECT_EQ(scene.camera->viewpoint, (Vec3{54, 75, 200}));
    EXPECT_EQ(scene.camera->upper_left, (Vec3{27, 121, 0}));
    ASSERT_THAT(scene.lights, SizeIs(1));
    EXPECT_EQ(scene.lights[0].intensity, 13000);
    EXPECT_THAT(scene.materials, SizeIs(7));
    EXPECT_THAT(scene.geometry.items, SizeIs(14));
    EXPECT_THAT(scene.geometry.polygons, SizeIs(11));
    EXPECT_THAT(scene.geometry.spheres, SizeIs(2));
    ASSERT_THAT(scene.geometry.rotational_shapes, SizeIs(1));
    EXPECT_THAT(scene.geometry.rotational_shapes[0].contour, SizeIs(3));
    EXPECT_EQ(scene.geometry.primitive_count, 14U);

    const auto material_of = [&](std::size_t item) {
        return scene.materials[static_cast<std::size_t>(scene.geometry.items[item].material)].name;
    };
    EXPECT_EQ(material_of(0), "darkwhite");
    EXPECT_EQ(material_of(6), "refwhite");
    EXPECT_EQ(material_of(13), "darkgrey");
}

TEST(VeraScene, WarnsOfTheOneFaceInThePaperWhoseInnerPointIsOnTheWrongSide) {
    const SceneFile file = read_scene(VERA_SOURCE_DIR "/scenes/still_life.vera");
    ASSERT_THAT(file.warnings, SizeIs(1));
    const Diagnostic& warning = file.warnings[0];
    EXPECT_EQ(warning.severity, Severity::warning);
    EXPECT_EQ(
        warning.problem,
        "the inner point is on the wrong side of this face: all other faces with the same inner "
        "point are on the other side");
    EXPECT_EQ(warning.remedy, "move IP to the inside of the solid");
    EXPECT_EQ(warning.line, "P4  90  0 -15    90  0 -55    90 40 -55    90 40 -15");
    EXPECT_EQ(warning.place.line, 20U);
    EXPECT_EQ(warning.place.column, 1U);
}

TEST(VeraScene, ReadsTheExampleAsItIsPrintedWithACommentThatIsNeverClosed) {
    EXPECT_EQ(
        said_of(within_scene("LI 110.0 100.0\n"
                             "-25.0 13000.0 1.0 1.0 1.0 (* light source 8000\n"
                             "(* geometry *)\n"
                             "SP 0 0 0 2")),
        "test.vera:4:1: warning: '(*' inside the comment that begins in line 3\n"
        "    (* geometry *)\n"
        "    ^~\n"
        "  comments do not nest: both end at the next '*)'\n");
}

TEST(VeraScene, ReadsEveryStatement) {
    const SceneFile file = read_text(R"(
        LI 1 2 3  100  1 0.5 .25
        PARALLEL 0 0 -1  0 0 0  4 0 0  0 3 0
        CM glass
        SP 1 2 3 4
        P3 0 0 0  1 0 0  0 1 0
        P4 0 0 0  1 0 0  1 1 0  0 1 0
        PN 5  0 0 0  2 0 0  2 2 0  1 1 0  0 2 0
        PA 0 0 0  1 0 0  0 1 0   0 0 1  0 1 1  1 0 1
        RS 0 0 0  P 0 0 5  AN 0 0  GE 1 0
        RK 0 0 0  V 0 2 0  AN 1 0  GE 1 2 KE 1 3 0.5 0 3
        SSC part TR 1 2 3
        MA glass DRF 1 2 3 ARF 4 5 6 SDI 7 8 9 SAN 10 11 12 RAB 13 14 15 TAB 16 17 18 SPC 0.5 REF 1.5
        SCENE part SP 0 0 0 1
    )");
    const Scene& scene = file.scene;
    EXPECT_THAT(file.warnings, SizeIs(0));
    ASSERT_TRUE(scene.camera);
    EXPECT_EQ(scene.camera->projection, Camera::Projection::parallel);
    EXPECT_EQ(scene.camera->direction, (Vec3{0, 0, -1}));
    EXPECT_EQ(scene.camera->upper_left, (Vec3{0, 3, 0}));
    ASSERT_THAT(scene.lights, SizeIs(1));
    EXPECT_EQ(scene.lights[0].position, (Vec3{1, 2, 3}));
    EXPECT_EQ(scene.lights[0].color, (Color{1, 0.5, 0.25}));
    EXPECT_EQ(scene.lights[0].falloff, Falloff::inverse_square);

    using enum ItemKind;
    const Geometry& geometry = scene.geometry;
    EXPECT_THAT(
        kinds(geometry),
        ElementsAre(
            sphere,
            triangle,
            polygon,
            polygon,
            patch,
            rotational_shape,
            rotational_shape,
            subscene_call));
    EXPECT_EQ(geometry.spheres[0].center, (Vec3{1, 2, 3}));
    EXPECT_EQ(geometry.spheres[0].radius, 4);
    EXPECT_EQ(geometry.triangles[0].corners[1], (Vec3{1, 0, 0}));
    EXPECT_EQ(geometry.polygons[0].shape, Polygon::Shape::convex);
    EXPECT_EQ(geometry.polygons[0].normal, (Vec3{0, 0, 1}));
    EXPECT_EQ(geometry.polygons[1].shape, Polygon::Shape::simple);
    EXPECT_EQ(geometry.polygons[1].first_corner, 4U);
    EXPECT_EQ(geometry.polygons[1].corner_count, 5U);
    EXPECT_EQ(geometry.corners[7], (Vec3{1, 1, 0}));
    EXPECT_EQ(geometry.patches[0].normals[2], (Vec3{1, 0, 1}));
    EXPECT_EQ(geometry.rotational_shapes[0].axis, (Vec3{0, 0, 1}));
    EXPECT_EQ(geometry.rotational_shapes[1].axis, (Vec3{0, 1, 0}));
    EXPECT_EQ(geometry.rotational_shapes[1].contour[1].weight, 0.5);
    EXPECT_EQ(geometry.calls[0].to_parent.translation, (Vec3{1, 2, 3}));
    EXPECT_EQ(geometry.calls[0].from_parent.translation, (Vec3{-1, -2, -3}));
    EXPECT_EQ(geometry.items[2].line, 7U);

    ASSERT_THAT(scene.materials, SizeIs(1));
    const Material& material = scene.materials[0];
    EXPECT_EQ(material.drf, (Color{1, 2, 3}));
    EXPECT_EQ(material.arf, (Color{4, 5, 6}));
    EXPECT_EQ(material.sdi, (Color{7, 8, 9}));
    EXPECT_EQ(material.san, (Color{10, 11, 12}));
    EXPECT_EQ(material.rab, (Color{13, 14, 15}));
    EXPECT_EQ(material.tab, (Color{16, 17, 18}));
    EXPECT_EQ(material.spc, 0.5);
    EXPECT_EQ(material.ref, 1.5);
}

TEST(VeraScene, AppliesTransformationsInTheOrderInWhichTheyAreWritten) {
    const Scene scene = read_text(within_scene("SSC s TR 1 0 0 RT 0 0 90 SC 2 "
                                               "MX 1 0 0 5  0 1 0 6  0 0 -1 7\n"
                                               "SCENE s SP 0 0 0 1 LI 0 0 0 1 1 1 1"))
                            .scene;
    const Affine3& map = scene.geometry.calls.at(0).to_parent;
    // (1, 0, 1): (2, 0, 1), (0, 2, 1), (0, 4, 2), (5, 10, 5)
    EXPECT_EQ(transformed_point(map, {1, 0, 1}), (Vec3{5, 10, 5}));
    EXPECT_EQ(transformed_point(scene.geometry.calls[0].from_parent, {5, 10, 5}), (Vec3{1, 0, 1}));
}

TEST(VeraScene, TakesSectionsInAnyOrder) {
    const SceneFile file = read_text("SCENE s SP 0 0 0 1\n"
                                     "MA red DRF 1 0 0\n"
                                     "CM red SSC s\n"
                                     "LI 0 0 0 1 1 1 1\n"
                                     "SP 0 0 0 2\n"
                                     "PROJECTION 0 0 9 -1 -1 0 1 -1 0 -1 1 0\n"
                                     "SP 0 0 0 3\n");
    EXPECT_THAT(file.warnings, SizeIs(0));
    EXPECT_THAT(
        kinds(file.scene.geometry),
        ElementsAre(ItemKind::subscene_call, ItemKind::sphere, ItemKind::sphere));
    ASSERT_THAT(file.scene.subscenes, SizeIs(1));
    EXPECT_THAT(kinds(file.scene.subscenes[0]), ElementsAre(ItemKind::sphere));
}

TEST(VeraScene, ResumesTheMainSceneAndItsAttributesAfterASubscene) {
    for (const std::string ends : {"MA x", "LI 0 0 0 1 1 1 1"}) {
        const SceneFile file = read_text(
            "CM a IP 0 0 -5 P3 0 0 0 1 0 0 0 1 0\n"
            "SCENE s CM b P3 0 0 0 1 0 0 0 1 0 SP 0 0 0 1\n"
            "IP 0 0 5 P3 0 0 0 1 0 0 0 1 0 \n"
            + ends
            + " P3 0 0 0 1 0 0 0 1 0\n"
              "SCENE t P3 0 0 0 1 0 0 0 1 0 LI 0 0 0 1 1 1 1\n"
              "SSC s SSC t CM x SP 0 0 0 1 MA a MA b "
            + (ends == "MA x" ? "" : "MA x"));
        const Scene& scene = file.scene;
        EXPECT_THAT(file.warnings, SizeIs(0));
        EXPECT_THAT(
            kinds(scene.geometry),
            ElementsAre(
                ItemKind::triangle,
                ItemKind::triangle,
                ItemKind::subscene_call,
                ItemKind::subscene_call,
                ItemKind::sphere));
        EXPECT_EQ(scene.geometry.items[0].outside, Outside::along_normal);
        EXPECT_EQ(scene.geometry.items[1].outside, Outside::along_normal);
        EXPECT_EQ(scene.geometry.items[1].material, scene.geometry.items[0].material);
        EXPECT_EQ(scene.geometry.items[3].material, scene.geometry.items[0].material);

        const Geometry& s = scene.subscenes[0];
        EXPECT_EQ(s.name, "s");
        EXPECT_EQ(s.items[0].outside, Outside::by_normal) << "a subscene starts without IP";
        EXPECT_EQ(s.items[2].outside, Outside::against_normal);
        EXPECT_NE(s.items[0].material, inherited_material);
        const Geometry& t = scene.subscenes[1];
        EXPECT_EQ(t.items[0].outside, Outside::by_normal);
        EXPECT_EQ(t.items[0].material, inherited_material);
    }
}

TEST(VeraScene, CommentsSeparateWords) {
    const SceneFile file = read_text(within_scene("SP(*a*)1(**)2(* *\n) ( *)3(***)4"));
    EXPECT_EQ(file.scene.geometry.spheres.at(0).center, (Vec3{1, 2, 3}));
    EXPECT_EQ(file.scene.geometry.spheres.at(0).radius, 4);
}

TEST(VeraScene, ReadsNumbersInAllTheirForms) {
    const SceneFile file =
        read_text(within_scene("SP 54 54.0 .5 +1e-3\r\n\tSP -5. 1E2 0000.25 12e+1"));
    const auto& spheres = file.scene.geometry.spheres;
    EXPECT_EQ(spheres.at(0).center, (Vec3{54, 54, 0.5}));
    EXPECT_EQ(spheres.at(0).radius, 1e-3);
    EXPECT_EQ(spheres.at(1).center, (Vec3{-5, 100, 0.25}));
    EXPECT_EQ(spheres.at(1).radius, 120);
}

TEST(VeraScene, ReadsANumberOfTenThousandDigits) {
    const std::string digits(10'000, '3');
    const SceneFile file = read_text(within_scene("SP 0." + digits + " 0 " + digits + "e-10000 1"));
    EXPECT_EQ(file.scene.geometry.spheres.at(0).center.x, 1.0 / 3);
    EXPECT_EQ(file.scene.geometry.spheres.at(0).center.z, 1.0 / 3);
}

TEST(VeraScene, SplitsAQuadrangleThatIsNotPlane) {
    const SceneFile file = read_text(within_scene("P4 0 0 0 1 0 0 1 1 1 0 1 0"));
    EXPECT_EQ(file.scene.geometry.polygons.at(0).shape, Polygon::Shape::split_quadrangle);
    EXPECT_EQ(file.scene.geometry.items.at(0).outside, Outside::by_normal);
}

TEST(VeraScene, SplitsAQuadrangleIntoTwoFacesWhereTheInnerPointIsOnDifferentSidesOfThem) {
    // The halves meet in the diagonal from corner 1 to 3, as in a valley.
    const SceneFile file = read_text(within_scene("IP 1 0 9 P4 0 0 0  1 -1 1  2 0 0  1 1 1"));
    const Geometry& geometry = file.scene.geometry;
    EXPECT_THAT(kinds(geometry), ElementsAre(ItemKind::polygon, ItemKind::sphere));
    EXPECT_EQ(geometry.items[0].outside, Outside::against_normal);

    const SceneFile other = read_text(within_scene("IP 1 9 0 P4 0 0 0  1 -1 1  2 0 0  1 1 1"));
    EXPECT_THAT(
        kinds(other.scene.geometry),
        ElementsAre(ItemKind::triangle, ItemKind::triangle, ItemKind::sphere));
}

TEST(VeraScene, LeavesTheOutsideToTheNormalWithoutInnerPoint) {
    const SceneFile file = read_text(within_scene("P3 0 0 0 1 0 0 0 1 0 IP 0 0 -1\n"
                                                  "P3 0 0 0 1 0 0 0 1 0\n"
                                                  "PA 0 0 0 1 0 0 0 1 0 0 0 1 0 0 1 0 0 1\n"
                                                  "IP 0 0 1 P4 0 0 0 1 0 0 1 1 0 0 1 0"));
    const auto& items = file.scene.geometry.items;
    EXPECT_EQ(items.at(0).outside, Outside::by_normal);
    EXPECT_EQ(items.at(1).outside, Outside::along_normal);
    EXPECT_EQ(items.at(2).outside, Outside::along_normal);
    EXPECT_EQ(items.at(3).outside, Outside::against_normal);
}

TEST(VeraScene, ReadsTenThousandNestedSubscenes) {
    std::string text = within_scene("SSC s0");
    for (int i = 0; i < 10'000; ++i)
        text += "SCENE s" + std::to_string(i) + " SSC s" + std::to_string(i + 1) + " SP 0 0 0 1\n";
    text += "SCENE s10000 SP 0 0 0 1\n";
    const SceneFile file = read_text(text);
    EXPECT_THAT(file.warnings, SizeIs(0));
    EXPECT_EQ(file.scene.geometry.primitive_count, 10'002U);
    EXPECT_THAT(file.scene.subscenes, SizeIs(10'001));
}

TEST(VeraScene, TakesAFileThatBeginsWithAnEncodingMark) {
    EXPECT_EQ(said_of("\xef\xbb\xbf" + within_scene("")), "");
}

TEST(VeraScene, IsTheSameForEqualWordsInOtherLines) {
    const SceneFile one = read_text(within_scene("PN 3 0 0 0 1 0 0 0 1 0"));
    const SceneFile other = read_text(within_scene("PN\n3\n0\n0\n0\r\n1\n0\t0\n0\n1\n0"));
    EXPECT_EQ(one.scene.geometry.corners, other.scene.geometry.corners);
}

} // namespace
} // namespace vera
