// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/mesh_builder.h"

#include <algorithm>
#include <iterator>
#include <random>

#include "formats/mesh_text.h"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(ReadObj, ReadsVerticesAndTriangles) {
    const Mesh mesh = mesh_of(read_obj, "# two\n" + square + "f 1 2 3\nf 1 3 4\n");
    EXPECT_THAT(
        mesh.positions, ElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}));
    EXPECT_THAT(mesh.position_indices, ElementsAre(0, 1, 2, 0, 2, 3));
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_TRUE(mesh.normal_indices.empty());
    EXPECT_EQ(said_of(read_obj, square + "f 1 2 3\n"), "");
}

TEST(ReadObj, SplitsFacesOfMoreThanThreeCorners) {
    EXPECT_THAT(
        mesh_of(read_obj, square + "f 1 2 3 4\n").position_indices, ElementsAre(0, 1, 2, 0, 2, 3));
    const Mesh arrow =
        mesh_of(read_obj, "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nv -1 -1 0\nf 1 2 3 4\nf 4 5 1\n");
    EXPECT_EQ(arrow.triangle_count(), 3U);
    EXPECT_EQ(doubled_area(arrow), (Vec3{0, 0, 4 + 4 + 4}));
}

TEST(ReadObj, KnowsTheLineOfEachTriangle) {
    // Each with what is read up to there: the triangles that it adds are those of its first line.
    const std::string statements[] = {
        "f 1 2 3\n",
        "f 1 2 3 4\n",
        "f 1 \\\n 2 3\n",
        "f 1 1 2\n",
        "\n",
        "# f 1 2 3 \\\n",
        "g a \\\n b\n",
        "v 0 0 5\n",
        "f -1 \\\n1 2 \\\n3\n",
        "f 1 2 3\r\n"};
    std::mt19937 random(5);
    for (int round = 0; round < 200; ++round) {
        std::string text = square + "f 2 3 4\n";
        std::vector<std::uint32_t> lines = {5};
        std::uint32_t line = 6;
        for (int i = 0; i < 8; ++i) {
            const std::string& statement = statements[random() % std::size(statements)];
            text += statement;
            lines.resize(mesh_of(read_obj, text).triangle_count(), line);
            line += static_cast<std::uint32_t>(std::ranges::count(statement, '\n'));
        }
        ASSERT_EQ(obj_triangle_lines(SourceText("test", text)), lines) << text;
    }
}

TEST(ReadObj, CountsNegativeNumbersBackwardsFromTheFace) {
    EXPECT_THAT(
        mesh_of(read_obj, square + "f -4 -3 -2\nv 9 9 9\nf -5 -4 -1\n").position_indices,
        ElementsAre(0, 1, 2, 0, 1, 4));
}

TEST(ReadObj, ReadsEveryFormOfACorner) {
    const Mesh mesh = mesh_of(
        read_obj,
        square
            + "vt 0 0\nvn 0 0 1\nvn 0 0 2\nf 1/1/2 2/1/1 3/1/1\nf 1//-1 3//-2 4//-2\n"
              "f 2//1 3//1 4//1\n");
    EXPECT_EQ(mesh.triangle_count(), 3U);
    EXPECT_THAT(
        triangle_normals(mesh, 0), ElementsAre(Vec3{0, 0, 2}, Vec3{0, 0, 1}, Vec3{0, 0, 1}));
    EXPECT_THAT(
        triangle_normals(mesh, 1), ElementsAre(Vec3{0, 0, 2}, Vec3{0, 0, 1}, Vec3{0, 0, 1}));
    EXPECT_TRUE(mesh_of(read_obj, square + "vt 0 0\nf 1/1 2/1 3/1\n").normals.empty());
}

TEST(ReadObj, KeepsNoSecondListOfNumbersWhereNormalsAreNumberedLikeVertices) {
    const std::string normals = "vn 0 0 1\nvn 0 0 2\nvn 0 0 3\nvn 0 0 4\n";
    const Mesh same = mesh_of(read_obj, square + normals + "f 1//1 2//2 3//3\nf 1//1 3//3 4//4\n");
    EXPECT_TRUE(same.normal_indices.empty());
    EXPECT_EQ(same.normals.size(), 4U);

    const Mesh other = mesh_of(read_obj, square + normals + "f 1//1 2//2 3//3\nf 1//1 3//3 4//2\n");
    EXPECT_THAT(other.normal_indices, ElementsAre(0, 1, 2, 0, 2, 1));
    const Mesh first = mesh_of(read_obj, square + normals + "f 1//4 2//2 3//3\n");
    EXPECT_THAT(first.normal_indices, ElementsAre(3, 1, 2));
}

TEST(ReadObj, GivesFacesWithoutNormalsTheirOwnWhereOthersHaveSome) {
    for (const char* faces :
         {"f 3 2 1\nf 1//1 2//1 3//1\nf 1/1 3/1 4/1\n",
          "f 3 2 1\nf 1//1 2//1 3//1\nf 1//1 3 4\n"}) {
        const Mesh mesh = mesh_of(read_obj, square + "vn 5 0 0\n" + faces);
        ASSERT_EQ(mesh.normal_indices.size(), mesh.position_indices.size());
        const Vec3 up = {0, 0, 1};
        EXPECT_THAT(triangle_normals(mesh, 0), ElementsAre(-up, -up, -up));
        EXPECT_THAT(
            triangle_normals(mesh, 1), ElementsAre(Vec3{5, 0, 0}, Vec3{5, 0, 0}, Vec3{5, 0, 0}));
        EXPECT_THAT(triangle_normals(mesh, 2), ElementsAre(up, up, up));
    }
    const std::string as_positions = square + "vn 5 0 0\nvn 5 0 0\nvn 5 0 0\nf 1//1 2//2 3//3\n";
    EXPECT_THAT(
        mesh_of(read_obj, as_positions + "f 1 3 4\n").normal_indices,
        ElementsAre(0, 1, 2, 3, 3, 3));
    EXPECT_TRUE(mesh_of(read_obj, square + "vn 5 0 0\nf 1 2 3\n").normals.empty());
}

TEST(ReadObj, GoesOnBehindABackslashAndNotBehindACommentsOne) {
    EXPECT_THAT(
        mesh_of(read_obj, "# c:\\models\\\nv 0 \\\n0 0\nv 1 0 0\nv \\\r\n 0 1 0\nf 1 2\\\n 3\n")
            .position_indices,
        ElementsAre(0, 1, 2));
}

TEST(ReadObj, PassesOverWhatMeshesDoNotNeed) {
    EXPECT_EQ(
        said_of(
            read_obj,
            "mtllib a.mtl\no thing\nv 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\n  v\t0 1 0 1 0 0 0 # end\r\n"
            "vt 0 0\ng a b\nusemtl red\ns off\nf 1 2 3 # face\nl 1 2\np 1\n\n   \n"),
        "");
}

TEST(ReadObj, NamesWhatItDoesNotKnowOnce) {
    EXPECT_EQ(
        said_of(read_obj, square + "f 1 2 3\nfroth 1\nfroth 2\n"),
        "test:6:1: warning: 2 statements are unknown, the first of them here, and left out\n"
        "    froth 1\n"
        "    ^\n");
    EXPECT_EQ(
        said_of(read_obj, square + "f 1 2 3\ncstype bezier\nsurf 0 1 0 1 1 2 3\nend\n"),
        "test:7:1: warning: free-form curves and surfaces are left out (1 statement)\n"
        "    surf 0 1 0 1 1 2 3\n"
        "    ^\n"
        "  let the program that wrote the file export polygons\n");
}

TEST(ReadObj, RefusesVerticesThatAreNotThereYet) {
    EXPECT_EQ(
        said_of(read_obj, square + "f 1 2 5\n"),
        "test:5:7: error: there is no vertex 5: 4 lines begin with 'v' before this face\n"
        "    f 1 2 5\n"
        "          ^\n"
        "  the first 'v' has the number 1, and the last before the face the number -1\n");
    EXPECT_THAT(
        said_of(read_obj, "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"),
        HasSubstr(
            "test:1:3: error: there is no vertex 1: 0 lines begin with 'v' before this face"));
    EXPECT_THAT(
        said_of(read_obj, "v 0 0 0\nf 0 1 1\n"),
        HasSubstr("test:2:3: error: there is no vertex 0: 1 line begins with 'v' before"));
    EXPECT_THAT(
        said_of(read_obj, square + "f 1 -5 2\n"),
        HasSubstr("test:5:5: error: there is no vertex -5: 4 lines"));
    EXPECT_THAT(
        said_of(read_obj, square + "vn 0 0 1\nf 1//1 2//2 3//1\n"),
        HasSubstr("test:6:11: error: there is no normal 2: 1 line begins with 'vn' before"));
    EXPECT_THAT(
        said_of(read_obj, square + "f 1 2 99999999999999999999999\n"),
        HasSubstr("there is no vertex 99999999999999999999999: 4 lines"));
}

TEST(ReadObj, RefusesCornersThatAreNone) {
    EXPECT_EQ(
        said_of(read_obj, square + "f 1 2 x\n"),
        "test:5:7: error: expected the number of a vertex of the face, found 'x'\n"
        "    f 1 2 x\n"
        "          ^\n"
        "  a corner is written 1, 1/2, 1//3 or 1/2/3: vertex, texture, normal\n");
    EXPECT_THAT(
        said_of(read_obj, square + "f 1 2 3//\n"),
        HasSubstr("test:5:10: error: expected the number of a normal of the face, found the end of "
                  "the line"));
    EXPECT_THAT(
        said_of(read_obj, square + "f 1 2.5 3\n"),
        HasSubstr("test:5:6: error: expected a blank behind the vertex of a face, found '.5'"));
    EXPECT_EQ(
        said_of(read_obj, square + "f 1 2\n"),
        "test:5:6: error: expected three or more vertices of the face, found 2\n"
        "    f 1 2\n"
        "         ^\n"
        "  write 'f 1 2 3'\n");
}

TEST(ReadObj, RefusesCoordinatesThatAreNoFiniteNumbers) {
    EXPECT_EQ(
        said_of(read_obj, "v 0 nan 0\nv 1e309 0 0\nv 1 2\nv 1 2 blue\nvn 0 0 -Inf\n"),
        "test:1:5: error: the y of the vertex is not a finite number: 'nan'\n"
        "    v 0 nan 0\n"
        "        ^~~\n"
        "  repair the program that wrote the file, or delete what uses this number\n"
        "test:2:3: error: the x of the vertex is too large a number: '1e309'\n"
        "    v 1e309 0 0\n"
        "      ^~~~~\n"
        "  the largest number is 1.797e308\n"
        "test:3:6: error: expected the z of the vertex, found the end of the line\n"
        "    v 1 2\n"
        "         ^\n"
        "test:4:7: error: expected the z of the vertex, found 'blue'\n"
        "    v 1 2 blue\n"
        "          ^~~~\n"
        "test:5:8: error: the z of the normal is not a finite number: '-Inf'\n"
        "    vn 0 0 -Inf\n"
        "           ^~~~\n"
        "  repair the program that wrote the file, or delete what uses this number\n");
}

TEST(ReadObj, EndsAfterTwentyErrors) {
    std::string text;
    for (int i = 0; i < 30; ++i)
        text += "v x\n";
    const std::string said = said_of(read_obj, text);
    EXPECT_THAT(said, HasSubstr("test:20:3: error"));
    EXPECT_THAT(said, testing::Not(HasSubstr("test:21")));
    EXPECT_THAT(said, HasSubstr("test: note: reading ended after 20 errors\n"));
}

TEST(ReadObj, LeavesOutFacesWithoutAreaAndSaysSoOnce) {
    const std::string text = square + "v 2 0 0\nf 1 2 2\nf 1 2 5\nf 1 2 3\nf 1 1 1 1\n";
    EXPECT_EQ(mesh_of(read_obj, text).triangle_count(), 1U);
    EXPECT_EQ(
        said_of(read_obj, text),
        "test:6:1: warning: 3 faces without area are left out, the first of them here\n"
        "    f 1 2 2\n"
        "    ^\n");
    EXPECT_THAT(
        said_of(read_obj, square + "f 1 1 2\nf 1 2 3\n"),
        HasSubstr("test:5:1: warning: a face without area is left out\n"));
    EXPECT_THAT(
        said_of(read_obj, square + "f 1 1 2\n"),
        HasSubstr("test:5:1: error: no face of the mesh has an area\n"));
}

TEST(ReadObj, KeepsFacesThatAreOnlyTiny) {
    EXPECT_EQ(
        mesh_of(read_obj, "v 0 0 0\nv 1e-300 0 0\nv 0 1e-300 0\nf 1 2 3\n").triangle_count(), 1U);
}

TEST(ReadObj, WarnsOfFacesWhoseSidesCross) {
    EXPECT_EQ(
        said_of(read_obj, square + "f 1 3 2 4\n"),
        "test:5:1: warning: the sides of a face cross: it is split as well as may be\n"
        "    f 1 3 2 4\n"
        "    ^\n"
        "  write such a face as triangles\n");
    EXPECT_THAT(
        said_of(read_obj, square + "f 1 3 2 4\nf 1 3 2 4\n"),
        HasSubstr("test:5:1: warning: the sides of 2 faces cross, the first of them here: they are "
                  "split as well as may be\n"));
}

TEST(ReadObj, RefusesAFileWithoutFaces) {
    EXPECT_EQ(
        said_of(read_obj, square),
        "test:5:1: error: the mesh has no face\n"
        "  a mesh needs triangles: points and lines are not shown\n");
    EXPECT_THAT(said_of(read_obj, ""), HasSubstr("error: the mesh has no face"));
    EXPECT_THAT(said_of(read_obj, "\x7f\x45LF\x02\x01\n"), HasSubstr("the mesh has no face"));
}

TEST(ReadObj, KeepsLargeFacesReadable) {
    // A face of a thousand corners, round a circle, and its neighbours.
    std::string text;
    std::string face = "f";
    for (int i = 0; i < 1000; ++i) {
        text += fmt::format("v {} {} 0\n", i, i * i);
        face += fmt::format(" {}", i + 1);
    }
    EXPECT_EQ(mesh_of(read_obj, text + face).triangle_count(), 998U);
}

TEST(MeshBuilder, RefusesMoreTrianglesThanASceneCanNumber) {
    EXPECT_EQ(MeshBuilder::most_triangles, 4294967294U);
    const SourceText source("big.obj", "f 1 2 3 4\n");
    SourceReport report(source);
    MeshBuilder builder(report, 3); // the limit's place is what counts
    builder.mesh().positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const MeshCorner corners[] = {{0}, {1}, {2}, {3}};
    EXPECT_TRUE(builder.add_face(corners, 0));
    EXPECT_FALSE(builder.add_face(corners, 0));
    std::vector<Diagnostic> warnings;
    try {
        builder.finish(warnings);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(
            printed(error.diagnostics()),
            "big.obj:1:1: error: more than 3 triangles in one mesh\n"
            "    f 1 2 3 4\n"
            "    ^\n"
            "  split the mesh into several files\n");
    }
}

} // namespace
} // namespace vera
