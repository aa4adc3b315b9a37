// SPDX-License-Identifier: Apache-2.0
#include "formats/mesh_text.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string vertex_properties = "property float x\nproperty float y\nproperty float z\n";
const std::string face_property = "property list uchar int vertex_indices\n";

std::string header(const std::string& format, int vertices, int faces) {
    return "ply\nformat " + format + " 1.0\ncomment of no importance\nelement vertex "
        + std::to_string(vertices) + "\n" + vertex_properties + "element face "
        + std::to_string(faces) + "\n" + face_property + "end_header\n";
}

const std::string square = header("ascii", 4, 2) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

TEST(ReadPly, ReadsAscii) {
    const Mesh mesh = mesh_of(read_ply, square + "3 0 1 2\n4 0 1 2 3\n");
    EXPECT_THAT(
        mesh.positions, ElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}));
    EXPECT_THAT(mesh.position_indices, ElementsAre(0, 1, 2, 0, 1, 2, 0, 2, 3));
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_EQ(said_of(read_ply, square + "3 0 1 2\n3 0 1 3"), "");
}

TEST(ReadPly, ReadsNormals) {
    const std::string normals = "property float nx\nproperty float ny\nproperty float nz\n";
    std::string text = header("ascii", 3, 1) + "0 0 0 1 0 0\n1 0 0 0 1 0\n0 1 0 0 0 1\n3 2 0 1\n";
    text.insert(text.find("element face"), normals);
    const Mesh mesh = mesh_of(read_ply, text);
    EXPECT_TRUE(mesh.normal_indices.empty());
    EXPECT_THAT(
        triangle_normals(mesh, 0), ElementsAre(Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0, 1, 0}));
}

/// Elements and properties in an unusual order, of every type, with others among them.
std::string every_type(ByteOrder order) {
    std::string text = std::string("ply\r\nformat ")
        + (order == ByteOrder::little ? "binary_little_endian" : "binary_big_endian")
        + " 1.0\r\nobj_info none\r\nelement face 1\r\nproperty uchar flag\r\n"
          "property list ushort uint vertex_index\r\nproperty list int double weights\r\n"
          "element camera 2\r\nproperty list uchar short a\r\nproperty char b\r\n"
          "element vertex 3\r\nproperty double nx\r\nproperty double x\r\nproperty short y\r\n"
          "property uchar z\r\nproperty float32 ny\r\nproperty int8 nz\r\nproperty uint8 red\r\n"
          "end_header\r\n";
    const auto put = [&](auto value) { append(text, value, order); };
    put(std::uint8_t{7});
    put(std::uint16_t{3});
    for (const std::uint32_t i : {0U, 1U, 2U})
        put(i);
    put(std::int32_t{2});
    put(0.5);
    put(0.25);
    for (const std::uint8_t count : {std::uint8_t{2}, std::uint8_t{0}}) {
        put(count);
        for (std::uint8_t i = 0; i < count; ++i)
            put(std::int16_t{-300});
        put(std::int8_t{3});
    }
    const double x[] = {0, 1.1, -2.5};
    const std::int16_t y[] = {0, -2, 300};
    const std::uint8_t z[] = {0, 1, 200};
    for (std::size_t i = 0; i < 3; ++i) {
        put(0.125);
        put(x[i]);
        put(y[i]);
        put(z[i]);
        put(0.5F);
        put(std::int8_t{-1});
        put(std::uint8_t{255});
    }
    return text;
}

TEST(ReadPly, ReadsBinaryOfEitherByteOrderWhateverTheOrderAndTypes) {
    for (const ByteOrder order : {ByteOrder::little, ByteOrder::big}) {
        const Mesh mesh = mesh_of(read_ply, every_type(order));
        EXPECT_THAT(
            triangle(mesh, 0), ElementsAre(Vec3{0, 0, 0}, Vec3{1.1, -2, 1}, Vec3{-2.5, 300, 200}));
        const Vec3 normal = {0.125, 0.5, -1};
        EXPECT_THAT(triangle_normals(mesh, 0), ElementsAre(normal, normal, normal));
        EXPECT_EQ(said_of(read_ply, every_type(order)), "");
    }
}

TEST(ReadPly, SaysOfEveryTruncatedFileThatItIsCutShort) {
    const std::string whole = every_type(ByteOrder::big);
    for (std::size_t size = 4; size < whole.size(); ++size) {
        const std::string said = said_of(read_ply, whole.substr(0, size));
        ASSERT_THAT(said, HasSubstr("error: ")) << size;
        if (size > whole.find("end_header") + 12) {
            ASSERT_THAT(said, HasSubstr("cut short: get a whole copy of it")) << size;
        }
    }
    const std::string ascii = square + "3 0 1 2\n4 0 1 2 3\n";
    for (std::size_t size = 4; size + 2 < ascii.size(); ++size)
        ASSERT_THAT(said_of(read_ply, ascii.substr(0, size)), HasSubstr("error: ")) << size;
}

TEST(ReadPly, BelievesNoCountThatTheFileHasNoRoomFor) {
    EXPECT_EQ(
        said_of(read_ply, header("binary_little_endian", 2'000'000'000, 1) + "123456"),
        "test:4:1: error: 2000000000 elements 'vertex' of at least 12 bytes are promised, but at "
        "most 6 bytes are left of the file\n"
        "    element vertex 2000000000\n"
        "    ^~~~~~~\n"
        "  the file is cut short: get a whole copy of it\n");
    EXPECT_THAT(
        said_of(read_ply, header("ascii", 3, 2'000'000'000) + "0 0 0 0 0 0 0 0 0\n3 0 1 2\n"),
        HasSubstr("2000000000 elements 'face' of at least 1 byte are promised"));
    // A list of four thousand million numbers.
    std::string list = header("binary_little_endian", 0, 1) + "\xff\xff\xff\xff" + "1234";
    list.replace(list.find("uchar"), 5, "uint");
    EXPECT_THAT(
        said_of(read_ply, list),
        HasSubstr("expected the number of a vertex of the face, but the file ends\n"));
}

TEST(ReadPly, TakesAnyNumberOfElementsWithoutProperties) {
    std::string text = square + "3 0 1 2\n3 0 1 3\n";
    text.insert(text.find("element vertex"), "element nothing 999999999999999999\n");
    EXPECT_EQ(mesh_of(read_ply, text).triangle_count(), 2U);
}

TEST(ReadPly, RefusesVerticesThatAreNotThere) {
    EXPECT_EQ(
        said_of(read_ply, square + "3 0 1 4\n3 0 -1 2\n"),
        "test:15:7: error: there is no vertex 4: the file has 4 vertices, numbered from 0\n"
        "    3 0 1 4\n"
        "          ^\n"
        "  the file is damaged: get another copy of it\n"
        "test:16:5: error: there is no vertex -1: the file has 4 vertices, numbered from 0\n"
        "    3 0 -1 2\n"
        "        ^~\n"
        "  the file is damaged: get another copy of it\n");
    std::string binary = header("binary_big_endian", 1, 1);
    const std::size_t data = binary.size();
    for (int i = 0; i < 3; ++i)
        append(binary, 1.0F, ByteOrder::big);
    append(binary, std::uint8_t{3}, ByteOrder::big);
    for (const std::int32_t i : {0, 0, 1})
        append(binary, i, ByteOrder::big);
    EXPECT_EQ(
        said_of(read_ply, binary),
        "test: error: byte " + std::to_string(data + 21)
            + ": there is no vertex 1: the file has 1 vertex, numbered from 0\n"
              "  the file is damaged: get another copy of it\n");
}

TEST(ReadPly, RefusesNumbersThatAreNotFinite) {
    EXPECT_THAT(
        said_of(read_ply, header("ascii", 3, 1) + "0 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n"),
        HasSubstr("test:12:3: error: the y of the vertex is not a finite number: 'inf'\n"));
    std::string binary = header("binary_little_endian", 1, 1);
    const std::size_t data = binary.size();
    for (const float value : {1.0F, std::numeric_limits<float>::quiet_NaN(), 1.0F})
        append(binary, value, ByteOrder::little);
    EXPECT_EQ(
        said_of(read_ply, binary + std::string(1, '\0')),
        "test: error: byte " + std::to_string(data + 4)
            + ": the y of the vertex is not a finite number\n"
              "  repair the program that wrote the file, or delete what uses this number\n");
    // What is passed over may be anything.
    std::string quality = header("ascii", 3, 1) + "0 0 0 nan\n1 0 0 nan\n0 1 0 nan\n3 0 1 2\n";
    quality.insert(quality.find("element face"), "property float quality\n");
    EXPECT_EQ(said_of(read_ply, quality), "");
}

TEST(ReadPly, RefusesListsThatAreNone) {
    EXPECT_THAT(
        said_of(read_ply, square + "-3 0 1 2\n3 0 1 2\n"),
        HasSubstr("test:15:1: error: expected the length of a list, found -3\n"));
    EXPECT_THAT(
        said_of(read_ply, square + "2 0 1\n3 0 1 2\n"),
        HasSubstr("test:15:1: error: expected three or more vertices of the face, found 2\n"));
}

/// What is said of a header whose line is another.
std::string said_of_header(const std::string& line, const std::string& other) {
    std::string text = square + "3 0 1 2\n3 0 1 3\n";
    text.replace(text.find(line), line.size(), other);
    return said_of(read_ply, text);
}

TEST(ReadPly, SaysWhatIsWrongWithAHeader) {
    EXPECT_EQ(
        said_of(read_ply, "solid a\n"),
        "test:1:1: error: expected 'ply' at the beginning of a PLY file, found 'solid'\n"
        "    solid a\n"
        "    ^~~~~\n"
        "  check the file's name and format\n");
    EXPECT_THAT(
        said_of_header("ascii", "utf8"),
        HasSubstr("test:2:8: error: expected 'ascii', 'binary_little_endian' or "
                  "'binary_big_endian', found 'utf8'\n"));
    EXPECT_THAT(
        said_of_header("format ascii 1.0\n", ""),
        HasSubstr("test:1:1: error: the header has no 'format' line\n"));
    EXPECT_THAT(
        said_of_header("vertex 4", "vertex four"),
        HasSubstr("test:4:16: error: expected how many of the element follow, found 'four'\n"));
    EXPECT_THAT(
        said_of_header("element vertex 4\n", ""),
        HasSubstr("test:4:1: error: a property before any element\n"));
    EXPECT_THAT(
        said_of_header("float y", "half y"),
        HasSubstr("test:6:10: error: expected the type of the property, found 'half'\n"));
    EXPECT_THAT(
        said_of_header("float y", "float"),
        HasSubstr("expected the name of the property, found the end of the line\n"));
    EXPECT_THAT(
        said_of_header("list uchar", "list float"),
        HasSubstr("test:9:1: error: the length of a list must be a whole number\n"));
    EXPECT_THAT(
        said_of_header("element face", "element vertex"),
        HasSubstr("test:8:1: error: the element 'vertex' stands twice in the header\n"));
    EXPECT_THAT(
        said_of_header("end_header", "the_end"),
        HasSubstr("test:10:1: error: expected 'format', 'element', 'property', 'comment' or "
                  "'end_header', found 'the_end'\n"));
    EXPECT_THAT(
        said_of_header("float y", "float b"),
        HasSubstr("test:4:1: error: the element 'vertex' lacks a property x, y or z\n"));
    EXPECT_THAT(
        said_of_header("vertex_indices", "strip"),
        HasSubstr("test:8:1: error: the element 'face' lacks a list of whole numbers "
                  "'vertex_indices'\n"));
    EXPECT_THAT(
        said_of_header("element vertex", "element point"),
        HasSubstr("test:1:1: error: the file has no element 'vertex'\n"));
    EXPECT_THAT(
        said_of_header("element face", "element strip"), HasSubstr("the mesh has no face\n"));
    EXPECT_THAT(
        said_of(read_ply, "ply\nformat ascii 1.0\n"),
        HasSubstr("test:3:1: error: expected 'end_header', found the end of the file\n"));
}

} // namespace
} // namespace vera
