// SPDX-License-Identifier: Apache-2.0
// Materials of OBJ files: usemtl, mtllib, and files in MTL.
#include "vera/formats/mtl_file.h"
#include "vera/formats/obj_parts.h"
#include "vera/formats/read_scene.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "formats/mesh_text.h"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A folder that is there as long as this is.
class Folder {
public:
    Folder()
        : path_(
            std::filesystem::temp_directory_path()
            / (std::string("vera_obj_parts_")
               + ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
        std::filesystem::create_directories(path_);
    }

    ~Folder() {
        std::error_code error;
        std::filesystem::remove_all(path_, error);
    }

    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    /// The path of a file of that text.
    std::filesystem::path file(const std::string& name, const std::string& text) const {
        std::ofstream(path_ / name, std::ios::binary) << text;
        return path_ / name;
    }

private:
    std::filesystem::path path_;
};

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::vector<Material> materials_of(const std::string& text) {
    std::vector<Diagnostic> warnings;
    return read_mtl(SourceText("test.mtl", text), warnings);
}

std::string said_of_mtl(const std::string& text) {
    std::vector<Diagnostic> warnings;
    try {
        read_mtl(SourceText("test.mtl", text), warnings);
    } catch (const InputError& error) {
        return printed(error.diagnostics());
    }
    return printed(warnings);
}

/// Of the meshes of a scene, the numbers of their materials.
std::vector<std::uint32_t> numbers_of(const Scene& scene) {
    std::vector<std::uint32_t> numbers;
    for (const Item& item : scene.geometry.items)
        numbers.push_back(static_cast<std::uint32_t>(item.material));
    return numbers;
}

TEST(Mtl, IsWhatTheLightingFormulaHas) {
    const auto materials = materials_of(
        "# two\nnewmtl red paint\r\nKa 1 1 1\nKd 0.8 0.1 0.2\nKs 0.5 0.5 0.5\nNs 10\nillum 2\n"
        "newmtl glass\nKd 0.5\nd 0.25\nKs 0.2\nTf 1 0.5 1\nNi 1.5\nillum 7\nNs 1\nKe 0 0 0.5\n"
        "newmtl lamp\nKd 1 1 0\nillum 0\nnewmtl matte\nKd 0 1 0\nKs 1 1 1\nillum 1\nTr 0.5\n");
    ASSERT_EQ(materials.size(), 4U);
    EXPECT_EQ(materials[0].name, "red paint");
    EXPECT_EQ(materials[0].drf, (Color{0.8, 0.1, 0.2}));
    EXPECT_EQ(materials[0].spc, highlight_end(10));
    EXPECT_TRUE(is_black(materials[0].rab) && is_black(materials[0].tab));
    EXPECT_EQ(materials[1].drf, (Color{0.125, 0.125, 0.125}));
    EXPECT_EQ(materials[1].rab, (Color{0.2, 0.2, 0.2}));
    EXPECT_NEAR(materials[1].tab.g, 0.75 * 0.5 * 0.8, 1e-12);
    EXPECT_EQ(materials[1].ref, 1.5);
    EXPECT_EQ(materials[1].sdi, (Color{0, 0, 0.5}));
    EXPECT_EQ(materials[2].sdi, (Color{1, 1, 0}));
    EXPECT_TRUE(is_black(materials[2].drf));
    EXPECT_EQ(materials[3].spc, 1);
    EXPECT_EQ(materials[3].drf, (Color{0, 0.5, 0}));
    EXPECT_EQ(materials[3].tab, (Color{0.5, 0.5, 0.5}));
}

TEST(Mtl, HasHighlightsThatAreHalfAsBrightWhereThePowerOfTheCosineIs) {
    for (const double exponent : {1.0, 2.0, 10.0, 96.0, 1000.0, 1e6}) {
        const double cosine = std::pow(0.5, 1 / exponent);
        const double u = (1 - cosine) / (1 - highlight_end(exponent));
        EXPECT_NEAR((1 - u * u) * (1 - u * u), 0.5, 1e-6) << exponent;
    }
    EXPECT_EQ(highlight_end(0), highlight_end(1));
    EXPECT_LT(highlight_end(1e9), 1);
}

TEST(Mtl, SaysWhereAndWhatIsWrong) {
    EXPECT_THAT(
        said_of_mtl("newmtl a\nKd 0.5 blue 0\n"),
        HasSubstr("test.mtl:2:8: error: expected a number of 'Kd', found 'blue'"));
    EXPECT_THAT(
        said_of_mtl("Kd 1 1 1\n"),
        HasSubstr("test.mtl:1:1: error: 'Kd' before the first 'newmtl'"));
    EXPECT_THAT(said_of_mtl("newmtl \n"), HasSubstr("1:1: error: the material has no name"));
    EXPECT_THAT(
        said_of_mtl("newmtl a\nKd 2 0 0\nNs -1\n"),
        HasSubstr("2:4: warning: 2 numbers are beyond the range"));
    EXPECT_THAT(
        said_of_mtl("newmtl a\nmap_Kd wood.png\nbump wood.png\n"),
        HasSubstr("2:1: warning: pictures on materials are left out (2 statements)"));
    EXPECT_THAT(
        said_of_mtl("newmtl a\nKd spectral f.rfl 1\n"),
        HasSubstr("warning: colours as spectra or X Y Z are left out"));
    EXPECT_THAT(
        said_of_mtl("newmtl a\nfoo 1\n"), HasSubstr("2:1: warning: 1 statement is unknown"));
    EXPECT_EQ(said_of_mtl("newmtl a\nPr 0.5\nd -halo 0.5\nsharpness 60\n"), "");
}

TEST(ObjParts, AreAMeshForEachStretchOfOneMaterial) {
    const Folder folder;
    folder.file("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\nnewmtl idle\n");
    const auto path = folder.file(
        "a.obj",
        "mtllib m.mtl\n" + square
            + "f 1 2 3\nusemtl blue\nf 1 3 4\nusemtl red\nusemtl blue\nf 2 3 4\nusemtl red\n"
              "f 1 2 4\nf 4 2 1\n");
    const SceneFile file = read_scene(path, {});
    EXPECT_TRUE(file.warnings.empty()) << printed(file.warnings);
    ASSERT_EQ(file.scene.materials.size(), 2U);
    EXPECT_EQ(file.scene.materials[0].name, "blue");
    EXPECT_EQ(file.scene.materials[0].drf, (Color{0, 0, 1}));
    EXPECT_EQ(file.scene.materials[1].drf, (Color{1, 0, 0}));
    EXPECT_THAT(
        numbers_of(file.scene), ElementsAre(static_cast<std::uint32_t>(inherited_material), 0, 1));
    const Geometry& geometry = file.scene.geometry;
    EXPECT_EQ(geometry.meshes[1].triangle_count(), 2U);
    EXPECT_EQ(geometry.meshes[2].positions.size(), 3U);
    EXPECT_EQ(geometry.items[0].line, 1U);
    EXPECT_EQ(geometry.items[1].line, 7U);
    EXPECT_EQ(geometry.items[2].line, 12U);
    // The numbers of primitives are those of the triangles of the file.
    EXPECT_EQ(geometry.primitive_count, 5U);
}

TEST(ObjParts, AreOneMeshWhereThereIsOneMaterialOrNone) {
    const Folder folder;
    folder.file("with blank.mtl", "newmtl red\nKd 1 0 0\n");
    const auto one = folder.file(
        "one.obj",
        "mtllib with blank.mtl\nusemtl red\n" + square + "f 1 2 3\nusemtl red\nf 1 3 4\n");
    EXPECT_THAT(numbers_of(read_scene(one, {}).scene), ElementsAre(0U));
    const auto none = folder.file("none.obj", "mtllib with blank.mtl\n" + square + "f 1 2 3\n");
    const SceneFile file = read_scene(none, {});
    EXPECT_THAT(
        numbers_of(file.scene), ElementsAre(static_cast<std::uint32_t>(inherited_material)));
    EXPECT_TRUE(file.scene.materials.empty());
}

TEST(ObjParts, SayWhatIsMissing) {
    const Folder folder;
    const auto missing =
        folder.file("a.obj", "mtllib gone.mtl\n" + square + "usemtl red\nf 1 2 3\n");
    const SceneFile file = read_scene(missing, {});
    EXPECT_THAT(
        printed(file.warnings),
        HasSubstr("a.obj:1:8: warning: there is no file 'gone.mtl': its materials have default"));
    EXPECT_EQ(file.warnings.size(), 1U);
    ASSERT_EQ(file.scene.materials.size(), 1U);
    EXPECT_EQ(file.scene.materials[0].name, "red");
    EXPECT_EQ(file.scene.materials[0].drf, Material::fallback().drf);

    const auto without = folder.file("b.obj", square + "usemtl red\nf 1 2 3\n");
    EXPECT_THAT(
        printed(read_scene(without, {}).warnings),
        AllOf(
            HasSubstr("b.obj:5:8: warning: no 'mtllib' names a file that defines materials"),
            HasSubstr("write 'mtllib FILE.mtl', or 'CM NAME' before MESH in a scene")));
    folder.file("m.mtl", "newmtl blue\n");
    const auto undefined =
        folder.file("c.obj", "mtllib m.mtl\n" + square + "usemtl red\nf 1 2 3\n");
    EXPECT_THAT(
        printed(read_scene(undefined, {}).warnings),
        HasSubstr("c.obj:6:8: warning: 1 material is in no file that 'mtllib' names"));
    folder.file("m.mtl", "newmtl red\nKd 1 x 1\n");
    try {
        read_scene(undefined, {});
        FAIL() << "a wrong number is taken";
    } catch (const InputError& error) {
        EXPECT_THAT(printed(error.diagnostics()), HasSubstr("m.mtl:2:6: error: expected"));
    }
}

TEST(ObjParts, AreReadBehindAMarkOfTheEncoding) {
    const Folder folder;
    folder.file("m.mtl", "\xef\xbb\xbfnewmtl red\r\nKd 1 0 0\r\n");
    const auto path = folder.file(
        "a.obj", "\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib m.mtl\nusemtl red\nf 1 2 3\n");
    const SceneFile file = read_scene(path, {});
    EXPECT_TRUE(file.warnings.empty()) << printed(file.warnings);
    EXPECT_EQ(file.scene.geometry.meshes.front().positions.size(), 3U);
    ASSERT_EQ(file.scene.materials.size(), 1U);
    EXPECT_EQ(file.scene.materials[0].drf, (Color{1, 0, 0}));
}

TEST(ObjParts, NameFilesThatAreNone) {
    const Folder folder;
    folder.file("m.mtl", "newmtl red\n");
    const auto said_of = [&](const std::string& names) {
        return printed(
            read_scene(
                folder.file("a.obj", "mtllib " + names + "\n" + square + "usemtl red\nf 1 2 3\n"),
                {})
                .warnings);
    };
    EXPECT_EQ(said_of("m.mtl # and no other"), "");
    EXPECT_EQ(said_of("m.mtl # of C:\\"), "") << "no backslash continues a comment";
    EXPECT_EQ(said_of("\\\n m.mtl"), "") << "one continues the line";
    EXPECT_EQ(said_of(" \\\r\nm.mtl\r"), "");
    EXPECT_THAT(said_of("n.mtl \\\nm.mtl"), HasSubstr("a.obj:1:8: warning: there is no file"));
    EXPECT_THAT(said_of("."), HasSubstr("'.' is not a file: its materials have default colours"));
    EXPECT_THAT(
        said_of("M.mtl"), HasSubstr("there is no file 'M.mtl' (did you mean 'm.mtl'?): its"));
}

TEST(ObjParts, AreAtMostSoMany) {
    std::string text = square;
    for (std::size_t i = 0; i <= most_material_runs; ++i)
        text += i % 2 == 0 ? "usemtl a\nf 1 2 3\n" : "usemtl b\nf 1 2 3\n";
    std::vector<Diagnostic> warnings;
    const Scene scene = read_obj_parts(SourceText("test.obj", text), warnings);
    EXPECT_EQ(scene.geometry.meshes.size(), 1U);
    EXPECT_TRUE(scene.materials.empty());
    EXPECT_THAT(printed(warnings), HasSubstr("the material changes more than 65536 times"));
    EXPECT_THAT(printed(warnings), HasSubstr("order the faces by material"));
}

TEST(ObjParts, HaveTheTrianglesOfTheWholeMeshInItsOrder) {
    std::mt19937 random(15);
    for (int round = 0; round < 60; ++round) {
        std::string text;
        for (int i = 0; i < 8; ++i)
            for (const char* const keyword : {"v", "vn"}) {
                text += keyword;
                for (int axis = 0; axis < 3; ++axis)
                    text += fmt::format(" {}", random() % 3);
                text += "\n";
            }
        const auto corners = round % 3; // with normals of their own, the positions' or none
        for (int i = 0; i < 12; ++i) {
            if (random() % 3 == 0)
                text += fmt::format("usemtl {}\n", random() % 3);
            text += "f";
            for (int corner = 0; corner < 3; ++corner) {
                const auto position = 1 + random() % 8;
                text += fmt::format(" {}", position);
                if (corners == 1)
                    text += fmt::format("//{}", position);
                else if (corners == 2 && i % 4 != 0)
                    text += fmt::format("//{}", 1 + random() % 8);
            }
            text += "\n";
        }
        text += "f 1 2 3\nf 1 3 4\nf 1 2 5\nf 2 3 6\nv 9 9 9\nv 8 9 9\nv 8 8 9\nf -1 -2 -3\n";
        std::vector<Diagnostic> warnings;
        const SourceText source("test.obj", text);
        const Mesh whole = read_obj(source, warnings);
        const Scene parts = read_obj_parts(source, warnings);
        std::size_t before = 0;
        for (const Mesh& part : parts.geometry.meshes) {
            ASSERT_GT(part.triangle_count(), 0U);
            ASSERT_EQ(part.normals.empty(), whole.normals.empty());
            for (std::size_t i = 0; i < part.triangle_count(); ++i) {
                EXPECT_EQ(triangle(part, i), triangle(whole, before + i));
                if (!whole.normals.empty()) {
                    EXPECT_EQ(triangle_normals(part, i), triangle_normals(whole, before + i));
                }
            }
            before += part.triangle_count();
        }
        EXPECT_EQ(before, whole.triangle_count());
    }
}

TEST(ObjParts, GiveWayToTheMaterialOfTheScene) {
    const Folder folder;
    folder.file("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    const std::string faces = square + "usemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\n";
    folder.file("a.obj", "mtllib m.mtl\n" + faces);
    folder.file("n.mtl", "newmtl red\nKd 0 1 0\nnewmtl blue\nKd 0 0 1\n");
    folder.file("b.obj", "mtllib n.mtl\n" + faces);
    const std::string head = "PROJECTION 0 0 9 -1 -1 0 1 -1 0 -1 1 0\nLI 0 0 9 1 1 1 1\n";
    const auto scene_of = [&](const std::string& text) {
        return read_scene(folder.file("s.vera", head + text), {}).scene;
    };
    // Its own, where none is said.
    const Scene own = scene_of("MESH \"a.obj\"\nMESH \"a.obj\" TR 1 0 0\n");
    ASSERT_EQ(own.subscenes.size(), 1U);
    EXPECT_THAT(
        [&] {
            std::vector<std::string> names;
            for (const Item& item : own.subscenes[0].items)
                names.push_back(own.materials[static_cast<std::size_t>(item.material)].name);
            return names;
        }(),
        ElementsAre("red", "blue"));
    EXPECT_EQ(own.geometry.primitive_count, 4U);
    // The scene's, where there is one.
    const Scene said = scene_of("MA m DRF 1 1 0\nCM m\nMESH \"a.obj\"\nMESH \"a.obj\" TR 1 0 0\n");
    EXPECT_EQ(said.materials.size(), 1U);
    EXPECT_THAT(numbers_of(said), ElementsAre(0U, 0U));
    EXPECT_EQ(said.geometry.meshes.front().triangle_count(), 2U);
    // Materials of the scene that have the names of the file's.
    const Scene defined = scene_of("MA red DRF 1 1 0\nMESH \"a.obj\"\n");
    ASSERT_EQ(defined.materials.size(), 2U);
    EXPECT_EQ(defined.materials[0].drf, (Color{1, 1, 0}));
    // Two files with different materials of one name.
    const Scene both = scene_of("MESH \"a.obj\"\nMESH \"b.obj\"\n");
    ASSERT_EQ(both.materials.size(), 3U);
    EXPECT_EQ(both.materials[2].name, "red-2");
    EXPECT_EQ(both.materials[2].drf, (Color{0, 1, 0}));
}

} // namespace
} // namespace vera
