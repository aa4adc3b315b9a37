// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/shared_points.h"

#include <limits>
#include <map>
#include <random>
#include <tuple>

#include "formats/mesh_text.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string facet(const std::string& a, const std::string& b, const std::string& c) {
    return "  facet normal 0 0 1\n    outer loop\n      vertex " + a + "\n      vertex " + b
        + "\n      vertex " + c + "\n    endloop\n  endfacet\n";
}

const std::string two_facets = facet("0 0 0", "1 0 0", "1 1 0") + facet("0 0 -0", "1 1 0", "0 1 0");

void append_triangle(std::string& bytes, const std::vector<float>& coordinates) {
    for (int i = 0; i < 3; ++i)
        append(bytes, 0.0F, ByteOrder::little);
    for (const float coordinate : coordinates)
        append(bytes, coordinate, ByteOrder::little);
    append(bytes, std::uint16_t{0}, ByteOrder::little);
}

std::string binary(const std::string& head, std::uint32_t count) {
    std::string bytes = head;
    bytes.resize(80, ' ');
    append(bytes, count, ByteOrder::little);
    append_triangle(bytes, {0, 0, 0, 1, 0, 0, 1, 1, 0});
    append_triangle(bytes, {0, 0, 0, 1, 1, 0, 0, 1, 0});
    return bytes;
}

TEST(ReadStl, ReadsAsciiAndSharesEqualCorners) {
    const Mesh mesh = mesh_of(read_stl, "solid a thing\n" + two_facets + "endsolid a thing\n");
    EXPECT_THAT(
        mesh.positions, ElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}));
    EXPECT_THAT(mesh.position_indices, ElementsAre(0, 1, 2, 0, 2, 3));
    EXPECT_EQ(said_of(read_stl, "solid\n" + two_facets + "endsolid"), "");
    EXPECT_EQ(said_of(read_stl, "\xef\xbb\xbfsolid\n" + two_facets + "endsolid"), "");
}

TEST(ReadStl, ReadsAsciiInCapitalsWithSeveralSolidsAndBadNormals) {
    std::string capitals = "\r\n SOLID a\r\n" + two_facets + "ENDSOLID\r\n";
    capitals.replace(capitals.find("facet normal 0"), 14, "FACET NORMAL nan");
    const Mesh mesh =
        mesh_of(read_stl, capitals + "solid b\n" + facet("0 0 0", "1 0 0", "0 0 5") + "endsolid b");
    EXPECT_EQ(mesh.triangle_count(), 3U);
    EXPECT_EQ(mesh.positions.size(), 5U);
}

TEST(ReadStl, ReadsBinaryAndSharesEqualCorners) {
    const Mesh mesh = mesh_of(read_stl, binary("made by hand", 2));
    EXPECT_THAT(mesh.position_indices, ElementsAre(0, 1, 2, 0, 2, 3));
    EXPECT_THAT(triangle(mesh, 1), ElementsAre(Vec3{0, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}));
}

TEST(ReadStl, KnowsABinaryFileThatBeginsWithSolidByItsSize) {
    EXPECT_EQ(mesh_of(read_stl, binary("solid is what it says", 2)).triangle_count(), 2U);
    // Cut short it has another size, but holds what no text holds.
    EXPECT_EQ(
        said_of(read_stl, binary("solid", 2).substr(0, 150)),
        "test: error: byte 80: 2 triangles are promised, but the file has room for 1\n"
        "  the file is cut short: get a whole copy of it (an ascii STL file begins with "
        "'solid')\n");
}

TEST(ReadStl, SaysWhereABinaryFileIsWrong) {
    EXPECT_EQ(
        said_of(read_stl, "too short"),
        "test: error: byte 9: expected the 84 bytes that a binary STL file begins with, but the "
        "file ends\n"
        "  an ascii STL file begins with 'solid'\n");
    EXPECT_THAT(
        said_of(read_stl, binary("x", 0xffffffff)),
        HasSubstr("byte 80: 4294967295 triangles are promised, but the file has room for 2\n"));
    EXPECT_THAT(
        said_of(read_stl, binary("x", 0)), HasSubstr("error: byte 184: the mesh has no face"));
    std::string infinite = binary("x", 3);
    append_triangle(infinite, {0, 0, 0, 1, std::numeric_limits<float>::infinity(), 0, 0, 0, 1});
    EXPECT_EQ(
        said_of(read_stl, infinite),
        "test: error: byte 208: corner 2 of triangle 3 has a coordinate that is not a finite "
        "number\n"
        "  repair the program that wrote the file, or delete what uses this number\n");
}

TEST(ReadStl, PassesOverWhatFollowsTheTriangles) {
    EXPECT_EQ(
        said_of(read_stl, binary("x", 1)),
        "test: warning: byte 134: what follows the last triangle is passed over: 50 bytes\n");
}

TEST(ReadStl, LeavesOutTrianglesWithoutAreaAndSaysSoOnce) {
    std::string bytes = binary("x", 4);
    append_triangle(bytes, {0, 0, 0, 1, 1, 1, 0, 0, 0});
    append_triangle(bytes, {0, 0, 0, 1, 1, 1, 2, 2, 2});
    EXPECT_EQ(mesh_of(read_stl, bytes).triangle_count(), 2U);
    EXPECT_EQ(
        said_of(read_stl, bytes),
        "test: warning: byte 184: 2 faces without area are left out, the first of them here\n");
}

TEST(ReadStl, SaysWhereAnAsciiFileIsWrong) {
    EXPECT_EQ(
        said_of(read_stl, "solid a\n  facet normal 0 0 1\n    outer loop\n      vertex 0 0"),
        "test:4:17: error: expected the z of the vertex, found the end of the file\n"
        "          vertex 0 0\n"
        "                    ^\n");
    EXPECT_EQ(
        said_of(read_stl, "solid\n" + two_facets + "facet normal 0 0 1\nouter lop\n"),
        "test:17:7: error: expected 'loop', found 'lop'\n"
        "    outer lop\n"
        "          ^~~\n");
    EXPECT_EQ(
        said_of(read_stl, "solid\n" + two_facets + "polygon\n"),
        "test:16:1: error: expected 'facet' or 'endsolid', found 'polygon'\n"
        "    polygon\n"
        "    ^~~~~~~\n");
    EXPECT_EQ(
        said_of(read_stl, "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n"),
        "test:6:1: error: expected 'vertex', found 'endloop'\n"
        "    endloop\n"
        "    ^~~~~~~\n"
        "  a facet has three of them\n");
    EXPECT_THAT(
        said_of(read_stl, "solid\nfacet\nouter loop\nvertex 0 nan 0\n"),
        HasSubstr("test:4:10: error: the y of the vertex is not a finite number: 'nan'\n"));
}

TEST(ReadStl, SaysOfEveryTruncatedAsciiFileThatItIsWrong) {
    const std::string whole = "solid a\n" + two_facets + "endsolid a\n";
    for (std::size_t size = 6; size < whole.size() - 12; ++size)
        ASSERT_THAT(said_of(read_stl, whole.substr(0, size)), HasSubstr("error: ")) << size;
    EXPECT_EQ(
        said_of(read_stl, "solid a\n" + two_facets),
        "test:16:1: error: expected 'facet' or 'endsolid', found the end of the file\n"
        "  the file is cut short: get a whole copy of it\n");
}

TEST(SharedPoints, NumbersPointsAsATreeOfThemDoes) {
    std::mt19937 random(1988);
    const double values[] = {-1, -0.0, 0, 1e-300, 0.1, 0.5, 1, 2, 1e300};
    std::vector<Vec3> points;
    SharedPoints shared(points);
    std::map<std::tuple<double, double, double>, std::uint32_t> reference;
    for (int round = 0; round < 20'000; ++round) {
        // From a grid that grows, so that the table does.
        const auto coordinate = [&] {
            return values[random() % 9] * static_cast<double>(1 + random() % 4);
        };
        const Vec3 point = {coordinate(), coordinate(), coordinate()};
        const auto next = static_cast<std::uint32_t>(reference.size());
        const auto known = reference.try_emplace({point.x, point.y, point.z}, next).first;
        ASSERT_EQ(shared.number_of(point), known->second) << "round " << round;
    }
    EXPECT_GT(points.size(), 2000U);
}

} // namespace
} // namespace vera
