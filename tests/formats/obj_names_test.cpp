// SPDX-License-Identifier: Apache-2.0
// Objects (o) and groups (g) of OBJ files: what their faces are named.
#include "vera/formats/obj_parts.h"
#include "vera/scene/named_parts.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "formats/mesh_text.h"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Scene scene_of(const std::string& text, ObjMaterials materials = ObjMaterials::of_file) {
    std::vector<Diagnostic> warnings;
    return read_obj_parts(SourceText("test.obj", text), warnings, materials);
}

/// "a/b", of an element of part b in part a; "" of one in none.
std::string names_of(const Geometry& geometry, Element element) {
    std::string names;
    for (std::uint32_t part = stretch_of(geometry, element).part; part != NamedPart::none;
         part = geometry.named_parts[part].parent)
        names.insert(0, geometry.named_parts[part].name + (names.empty() ? "" : "/"));
    return names;
}

/// Of each triangle of the file.
std::vector<std::string> all_names(const std::string& text) {
    Scene scene = scene_of(text);
    number_primitives(scene);
    std::vector<std::string> names;
    for (std::uint64_t i = 0; i < scene.geometry.element_count; ++i)
        names.push_back(names_of(scene.geometry, element_at(scene.geometry, i)));
    return names;
}

TEST(ObjNames, HoldForTheFacesAfterThem) {
    EXPECT_THAT(
        all_names(
            square
            + "f 1 2 3\no chair\nf 1 2 3\ng legs\nf 1 2 3 4\ng\nf 1 2 4\no table\nf 2 3 4\no\n"
              "f 1 2 3\ng top\nf 1 2 3\n"),
        ElementsAre("", "chair", "chair/legs", "chair/legs", "chair", "table", "", "top"));
}

TEST(ObjNames, AreTheWholeRestOfTheLine) {
    EXPECT_THAT(
        all_names(
            square
            + "o \t a chair \"of oak\" #1 \r\nf 1 2 3\ng a b\nf 1 2 3\r\no caf\xc3\xa9 <&>\nf 1 2 "
              "3\n"
              "o caf\xe9\nf 1 2 3\no\tx\\\ny\nf 1 2 3\n"),
        ElementsAre(
            "a chair \"of oak\" #1",
            "a chair \"of oak\" #1/a b",
            "caf\xc3\xa9 <&>",
            "caf\xe9",
            "x\\"));
}

TEST(ObjNames, OfNoFacesAreNone) {
    const Scene scene =
        scene_of(square + "g default\no empty\ng a\no b\nf 1 2 3\ng c\no d\nf 1 1 2\no\n");
    ASSERT_EQ(scene.geometry.named_parts.size(), 1U);
    EXPECT_EQ(scene.geometry.named_parts[0].name, "b");
    EXPECT_TRUE(scene_of(square + "o\ng\nf 1 2 3\n").geometry.named_parts.empty());
}

TEST(ObjNames, ThatAreThereTwiceAreOnePartOrTwo) {
    // Where they follow each other, one.
    const Scene one =
        scene_of(square + "o a\ng b\nf 1 2 3\ng b\nf 1 2 3\no a\nf 1 2 3\no a\ng b\nf 1 2 3\n");
    ASSERT_EQ(one.geometry.named_parts.size(), 3U);
    EXPECT_EQ(one.geometry.named_parts[0].end, (Element{1, 0}));
    EXPECT_EQ(one.geometry.named_parts[1].end, (Element{0, 2}));
    EXPECT_EQ(one.geometry.named_parts[2].first, (Element{0, 3}));
    const Scene two = scene_of(square + "o a\nf 1 2 3\no b\nf 1 2 3\no a\nf 1 2 3\n");
    ASSERT_EQ(two.geometry.named_parts.size(), 3U);
    EXPECT_EQ(two.geometry.named_parts[2].first, (Element{0, 2}));
    // A group of the same name in another object is another one.
    const Scene three = scene_of(square + "o a\ng b\nf 1 2 3\no c\ng b\nf 1 2 3\n");
    ASSERT_EQ(three.geometry.named_parts.size(), 4U);
    EXPECT_EQ(three.geometry.named_parts[3].parent, 2U);
}

TEST(ObjNames, GoOverMeshesOfSeveralMaterials) {
    const std::string text = square
        + "o a\nusemtl red\nf 1 2 3\nf 1 3 4\nusemtl blue\nf 1 2 3\no b\nf 1 2 3\nusemtl red\n"
          "o c\nf 1 2 3\n";
    const Scene scene = scene_of(text);
    ASSERT_EQ(scene.geometry.meshes.size(), 3U);
    const std::vector<NamedPart>& parts = scene.geometry.named_parts;
    ASSERT_EQ(parts.size(), 3U);
    EXPECT_EQ(parts[0].end, (Element{1, 1}));
    EXPECT_EQ(parts[1].first, (Element{1, 1}));
    EXPECT_EQ(parts[1].end, (Element{2, 0}));
    EXPECT_EQ(parts[2].first, (Element{2, 0}));
    EXPECT_EQ(parts[2].end, (Element{3, 0}));
    // Also where the materials are passed over.
    const Scene plain = scene_of(text, ObjMaterials::none);
    EXPECT_EQ(plain.geometry.meshes.size(), 1U);
    EXPECT_TRUE(plain.materials.empty());
    EXPECT_EQ(plain.geometry.named_parts[0].end, (Element{0, 3}));
}

TEST(ObjNames, AreAtMostSoMany) {
    std::string text = square + "f 1 2 3\n";
    for (std::size_t i = 0; i <= most_name_runs; ++i)
        text += i % 2 == 0 ? "g a\nf 1 2 3\n" : "g b\nf 1 2 3\n";
    text += "o c\nf 1 2 3\n";
    std::vector<Diagnostic> warnings;
    const Scene scene = read_obj_parts(SourceText("test.obj", text), warnings);
    EXPECT_TRUE(scene.geometry.named_parts.empty());
    EXPECT_THAT(
        printed(warnings),
        HasSubstr("test.obj:524296:1: warning: objects and groups (o and g) change more than "
                  "262144 times: none is taken"));
    EXPECT_THAT(printed(warnings), HasSubstr("order the faces by object and group"));
}

TEST(ObjNames, AreThoseThatAReaderLineByLineKeeps) {
    std::mt19937 random(60);
    constexpr std::array<const char*, 3> names = {"", "a", "b"};
    constexpr std::array<const char*, 3> group_names = {"", "c", "d"};
    std::size_t nested = 0;
    for (int round = 0; round < 400; ++round) {
        std::string text = square;
        std::string object;
        std::string group;
        std::vector<std::string> expected;
        for (int line = 0; line < 24; ++line) {
            const std::size_t number = random() % names.size();
            const std::string name = names[number];
            switch (random() % 5) {
            case 0:
                text += "o " + name + "\n";
                object = name;
                group.clear();
                break;
            case 1:
                group = group_names[number];
                text += "g " + group + "\n";
                break;
            case 2:
                text += "usemtl m" + name + "\n";
                break;
            default:
                text += "f 1 2 3\n";
                expected.push_back(object);
                expected.back().append(object.empty() || group.empty() ? "" : "/").append(group);
                nested += !object.empty() && !group.empty() ? 1 : 0;
            }
        }
        text += "o\nf 1 2 3\n";
        expected.emplace_back();
        ASSERT_EQ(all_names(text), expected) << text;
        const Geometry geometry = scene_of(text).geometry;
        for (std::size_t i = 0; i < geometry.named_parts.size(); ++i) {
            const NamedPart& part = geometry.named_parts[i];
            ASSERT_LT(part.first, part.end) << text;
            ASSERT_FALSE(part.name.empty());
            ASSERT_TRUE(
                part.end.triangle == 0
                || part.end.triangle < geometry.meshes[part.end.item].triangle_count());
            // None that could be one with that before it.
            for (std::size_t before = 0; before < i; ++before)
                ASSERT_FALSE(
                    geometry.named_parts[before].end == part.first
                    && geometry.named_parts[before].parent == part.parent
                    && geometry.named_parts[before].name == part.name)
                    << text;
        }
    }
    EXPECT_GT(nested, 500U);
}

} // namespace
} // namespace vera
