// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/vera_scene.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

SceneFile read(const std::string& text) {
    return read_vera_scene(SourceText("made.vera", text));
}

/// What is wrong with the text, as it is shown.
std::string errors(const std::string& text) {
    try {
        read(text);
    } catch (const InputError& error) {
        std::string all;
        for (const Diagnostic& diagnostic : error.diagnostics())
            all += to_text(diagnostic);
        return all;
    }
    return "";
}

TEST(MadeParts, StandWhereMkStandsInTheMaterialThatHoldsThere) {
    const SceneFile file = read("MA red DRF 1 0 0\n"
                                "CM red\n"
                                "SP 0 9 0 1\n"
                                "MK balls size 2 SC 2 TR 5 0 0\n");
    EXPECT_THAT(file.warnings, IsEmpty());
    const Geometry& main = file.scene.geometry;
    ASSERT_THAT(main.items, SizeIs(2));
    EXPECT_EQ(main.items[1].kind, ItemKind::subscene_call);
    EXPECT_EQ(main.items[1].line, 4U);
    EXPECT_EQ(main.items[1].material, main.items[0].material);
    EXPECT_EQ(main.primitive_count, 1U + 91U);
    EXPECT_EQ(main.calls[0].to_parent.translation, (Vec3{5, 0, 0}));
}

TEST(MadeParts, AreMadeOnceForTheSameValues) {
    const Scene once = read("MK tree levels 3\n").scene;
    const Scene twice = read("MK tree levels 3\nMK tree levels 3 seed 1 TR 9 0 0\n").scene;
    EXPECT_EQ(once.subscenes.size(), twice.subscenes.size());
    const Scene different = read("MK tree levels 3\nMK tree levels 3 seed 2\n").scene;
    EXPECT_GT(different.subscenes.size(), twice.subscenes.size());
}

TEST(MadeParts, TakeMaterialsOfTheTextThatHaveTheirNames) {
    const auto bark = [](const Scene& scene) {
        for (const Material& material : scene.materials)
            if (material.name == "tree-bark")
                return material.drf;
        return Color{};
    };
    EXPECT_EQ(bark(read("MK tree levels 1\nMA tree-bark DRF 1 0 0\n").scene), (Color{1, 0, 0}));
    const SceneFile standard = read("MK tree levels 1\n");
    EXPECT_THAT(standard.warnings, IsEmpty());
    EXPECT_GT(bark(standard.scene).g, 0);
}

TEST(MadeParts, MakeSurfacesOfFormulas) {
    const SceneFile file = read("CM grey\n"
                                "MK surface \"r*cos(u)*cos(v)\" \"r*sin(v)\" \"r*sin(u)*cos(v)\"\n"
                                "   let \"r=2\" u 0 \"2*pi\" v \"-pi/2\" \"pi/2\" deviation 0.1\n"
                                "MA grey DRF 0.5 0.5 0.5\n");
    EXPECT_THAT(file.warnings, IsEmpty());
    ASSERT_THAT(file.scene.subscenes, SizeIs(1));
    const Mesh& mesh = file.scene.subscenes[0].meshes.at(0);
    EXPECT_GT(mesh.triangle_count(), 50U);
    EXPECT_LT(mesh.triangle_count(), 2000U);
    for (const Vec3 position : mesh.positions)
        EXPECT_NEAR(length(position), 2, 1e-12);
}

TEST(MadeParts, SayWhatIsWrongAtItsPlace) {
    EXPECT_EQ(
        errors("MK bals\n").substr(0, 66),
        "made.vera:1:4: error: there is no generator 'bals'; did you mean '");
    EXPECT_THAT(
        errors("MK balls sise 3\n"),
        HasSubstr("made.vera:1:10: error: balls has no parameter 'sise'; did you mean 'size'?"));
    EXPECT_THAT(
        errors("MK balls size 2.5\n"),
        HasSubstr("made.vera:1:15: error: size of balls is 2.5, but must be a whole number"));
    EXPECT_THAT(errors("MK balls size x\n"), HasSubstr("expected the size, found 'x'"));
    EXPECT_THAT(
        errors("MK surface \"u\"\n  \"sine(v)\" \"v\"\n"),
        HasSubstr("made.vera:2:4: error: there is no 'sine'; did you mean 'sin'?"));
    EXPECT_THAT(
        errors("MK surface \"u\" \"v\" \"1\" u 2 1\n"),
        HasSubstr("made.vera:1:24: error: the range goes from 2 to 1"));
    EXPECT_THAT(
        errors("MK surface \"1/u\" \"v\" \"1\" u -1 1\n"),
        HasSubstr("made.vera:1:4: error: x has no finite value at u = 0, v = "));
    EXPECT_THAT(
        errors("MK surface \"u\" \"u\" \"u\"\n"),
        HasSubstr("made.vera:1:4: error: the surface has no area: all of it is one line"));
    EXPECT_THAT(
        errors("MK surface \"u\" \"v\" \"1\" deviation 0\n"), HasSubstr("must be positive"));
    EXPECT_THAT(errors("MK surface \"u\" 5\n"), HasSubstr("expected a formula in double quotes"));
    EXPECT_THAT(
        errors("MK balls size 2\n   size 3\n"),
        AllOf(
            HasSubstr("made.vera:2:4: error: size is given twice"),
            HasSubstr("  the first is at made.vera:1:10; keep one of them")));
    EXPECT_THAT(
        errors("MK surface \"u\" \"v\" \"1\" u 0 1 v 0 1 u 0 2\n"),
        AllOf(
            HasSubstr("made.vera:1:36: error: u is given twice"),
            HasSubstr("the first is at made.vera:1:24;")));
    EXPECT_THAT(
        errors("MK surface \"u\" \"v\" \"1\" deviation 1 deviation 1\n"),
        HasSubstr("deviation is given twice"));
    EXPECT_EQ(errors("MK surface \"u\" \"v*b\" \"a\" let \"a=2\" let \"b=3\"\n"), "");
    EXPECT_THAT(errors("SCENE MK SP 0 0 0 1\n"), HasSubstr("MK"));
}

} // namespace
} // namespace vera
