// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/read_scene.h"

#include <filesystem>
#include <fstream>

#include "formats/read_text.h"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace vera {

namespace {

using testing::HasSubstr;
using testing::SizeIs;

/// A folder of its own for each test, with files to be read.
class ReadScene : public testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir())
            / testing::UnitTest::GetInstance()->current_test_info()->name();
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }

    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path path(const std::string& name) const { return folder_ / name; }

    void write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories(path(name).parent_path());
        std::ofstream(path(name), std::ios::binary) << text;
    }

    /// What is said of a file, without the folder's name.
    std::string said(const std::string& name) const {
        std::string text;
        try {
            for (const Diagnostic& warning : read_scene(path(name)).warnings)
                text += to_text(warning);
        } catch (const InputError& error) {
            for (const Diagnostic& diagnostic : error.diagnostics())
                text += to_text(diagnostic);
        }
        const std::string prefix = folder_.string() + "/";
        for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix))
            text.erase(at, prefix.size());
        return text;
    }

private:
    std::filesystem::path folder_;
};

constexpr const char* tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                    "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

TEST_F(ReadScene, MakesASceneOfAMesh) {
    write("a.obj", tetrahedron);
    const SceneFile file = read_scene(path("a.obj"));
    EXPECT_FALSE(file.scene.camera);
    EXPECT_THAT(file.scene.lights, SizeIs(0));
    EXPECT_THAT(file.scene.geometry.items, SizeIs(1));
    EXPECT_EQ(file.scene.geometry.primitive_count, 4U);
    EXPECT_EQ(file.scene.files, std::vector<std::string>{path("a.obj").string()});
}

TEST_F(ReadScene, RefusesWhatReachesTooFarToBeComputedWith) {
    const std::string camera = "PROJECTION 0 0 8 -1 -1 4 1 -1 4 -1 1 4\nMA m DRF 1 1 1 CM m\n";
    const auto refused = [&](const std::string& name, const std::string& text) {
        write("far.vera", camera + text);
        return said("far.vera").find("this " + name + " reaches farther than 1e70 from the origin")
            != std::string::npos;
    };
    EXPECT_TRUE(refused("sphere", "SP 1e308 0 0 1e308"));
    EXPECT_TRUE(refused("sphere", "SP 1e71 0 0 1"));
    EXPECT_FALSE(refused("sphere", "SP 1e69 0 0 1e69"));
    EXPECT_TRUE(refused("triangle", "P3 0 0 0 1e71 0 0 0 1e71 0"));
    EXPECT_TRUE(refused("polygon", "P4 0 0 0 1e308 0 0 1e308 1e308 0 0 1e308 0"));
    EXPECT_TRUE(refused("rotational shape", "RK 1e308 0 0 P 1e308 1 0 AN 1e308 0 GE 1e308 1"));
    EXPECT_TRUE(refused("subscene", "SSC a SC 1e10 SCENE a SP 1e65 0 0 1"));
    EXPECT_TRUE(refused("subscene", "SSC a TR 1e300 0 0 SCENE a SP 0 0 0 1"));
    EXPECT_FALSE(refused("subscene", "SSC a TR 1e60 0 0 SCENE a SCENE b SP 0 0 0 1"));
    write("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1e300 0\nf 1 2 3\n");
    EXPECT_THAT(said("far.obj"), HasSubstr("this mesh reaches farther than 1e70"));
}

TEST_F(ReadScene, TakesTheFormatFromTheSettingsBeforeTheExtension) {
    write("a.txt", tetrahedron);
    EXPECT_THAT(said("a.txt"), HasSubstr("expected a statement, found 'v'"));
    const SceneFile file = read_scene(path("a.txt"), {.format = SceneFormat::obj});
    EXPECT_EQ(file.scene.geometry.primitive_count, 4U);
    EXPECT_EQ(scene_format_named("nff"), SceneFormat::nff);
    EXPECT_EQ(scene_format_named("gif"), std::nullopt);
}

TEST_F(ReadScene, ReadsNffByItsExtension) {
    write("a.NFF", "b 0 0 1\nl 1 2 3\nf 1 0 0 1 0 0 0 0\ns 0 0 0 1\n");
    EXPECT_THAT(read_scene(path("a.NFF")).scene.geometry.spheres, SizeIs(1));
}

TEST_F(ReadScene, NamesAFileThatIsNotThere) {
    try {
        read_scene(path("none.vera"));
        FAIL();
    } catch (const std::system_error& error) {
        EXPECT_THAT(error.what(), HasSubstr("cannot read '" + path("none.vera").string() + "'"));
    }
}

TEST_F(ReadScene, IncludesTextsFromTheFolderOfTheOneThatNamesThem) {
    write("a.vera", "CM red INCLUDE \"parts/b.vera\"\nSP 0 0 0 3\nINCLUDE \"parts/c.vera\"");
    write("parts/b.vera", "SP 0 0 0 1\nINCLUDE \"c.vera\" IP 1 1 1 CM blue");
    write("parts/c.vera", "\nSP 0 0 0 2");
    write("d.vera", "INCLUDE \"a.vera\" MA red MA blue");
    EXPECT_EQ(said("d.vera"), "");
    const Scene scene = read_scene(path("d.vera")).scene;
    const Geometry& geometry = scene.geometry;
    ASSERT_THAT(geometry.items, SizeIs(4));
    EXPECT_EQ(geometry.spheres[1].radius, 2);
    EXPECT_EQ(geometry.spheres[2].radius, 3);
    EXPECT_EQ(scene.files.at(geometry.items[1].file), path("parts/c.vera").string());
    EXPECT_EQ(geometry.items[1].line, 2U);
    EXPECT_EQ(scene.files.at(geometry.items[2].file), path("a.vera").string());
    EXPECT_EQ(geometry.items[2].line, 2U);
    EXPECT_EQ(geometry.items[1].material, geometry.items[0].material);
    EXPECT_NE(geometry.items[2].material, geometry.items[0].material) << "CM of the included text";
}

TEST_F(ReadScene, NamesTheFilesOfMeshesAndTheirMaterialsBehindThoseOfItems) {
    write("a.vera", "MESH \"a.obj\" MESH \"a.obj\" TR 1 0 0 INCLUDE \"b.vera\"");
    write("b.vera", "SP 0 0 0 1");
    write("a.obj", "mtllib a.mtl none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
    write("a.mtl", "newmtl red\nKd 1 0 0\n");
    const Scene scene = read_scene(path("a.vera")).scene;
    EXPECT_EQ(scene.files.at(scene.geometry.items.back().file), path("b.vera").string());
    ASSERT_THAT(scene.files, testing::SizeIs(testing::Ge(4U)));
    EXPECT_THAT(
        std::vector(scene.files.end() - 2, scene.files.end()),
        testing::ElementsAre(path("a.mtl").string(), path("a.obj").string()));
    EXPECT_THAT(
        read_scene(path("a.obj")).scene.files,
        testing::ElementsAre(path("a.obj").string(), path("a.mtl").string()));
}

TEST_F(ReadScene, GoesOnWithASubsceneThatAnIncludedTextBegins) {
    write("a.vera", "SSC s INCLUDE \"b.vera\" SP 0 0 0 2 MA m SP 0 0 0 3 CM m");
    write("b.vera", "SCENE s CM m SP 0 0 0 1");
    const Scene scene = read_scene(path("a.vera")).scene;
    EXPECT_THAT(scene.geometry.items, SizeIs(2));
    EXPECT_THAT(scene.subscenes.at(0).items, SizeIs(2));
}

TEST_F(ReadScene, TellsOfTextsThatIncludeThemselves) {
    write("a.vera", "SP 0 0 0 1\nINCLUDE \"b.vera\"");
    write("b.vera", "INCLUDE \"./a.vera\"");
    EXPECT_EQ(
        said("a.vera"),
        "b.vera:1:9: error: './a.vera' includes itself through 'b.vera'\n"
        "    INCLUDE \"./a.vera\"\n"
        "            ^~~~~~~~~~\n"
        "  take one of the INCLUDE statements out\n");
}

TEST_F(ReadScene, BoundsHowDeepAndHowOftenTextsAreIncluded) {
    for (int i = 0; i < 200; ++i)
        write(fmt::format("{}", i), fmt::format("INCLUDE \"{}\"", i + 1));
    EXPECT_THAT(said("0"), HasSubstr("100:1:9: error: more than 100 files include one another"));

    // Each includes the next one twice: without a bound, 2^60 of the last.
    for (int i = 0; i < 60; ++i)
        write(fmt::format("d{}", i), fmt::format(R"(INCLUDE "d{0}" INCLUDE "d{0}")", i + 1));
    write("d60", "");
    EXPECT_THAT(said("d0"), HasSubstr("more than 10000 INCLUDE statements are followed"));
}

TEST_F(ReadScene, SuggestsFilesThatAreThere) {
    write("materials.vera", "");
    write("bunny.ply", "");
    write("a.vera", "INCLUDE \"material.vera\"\nMESH \"buny.ply\"\nINCLUDE \"zzz.txt\"\n");
    EXPECT_EQ(
        said("a.vera"),
        "a.vera:1:9: error: there is no file 'material.vera'; did you mean 'materials.vera'?\n"
        "    INCLUDE \"material.vera\"\n"
        "            ^~~~~~~~~~~~~~~\n"
        "  files are looked for in the folder of the file that names them\n"
        "a.vera:2:6: error: there is no file 'buny.ply'; did you mean 'bunny.ply'?\n"
        "    MESH \"buny.ply\"\n"
        "         ^~~~~~~~~~\n"
        "  files are looked for in the folder of the file that names them\n"
        "a.vera:3:9: error: there is no file 'zzz.txt'\n"
        "    INCLUDE \"zzz.txt\"\n"
        "            ^~~~~~~~~\n"
        "  files are looked for in the folder of the file that names them\n");
}

TEST_F(ReadScene, TellsFilesForIncludeFromThoseForMesh) {
    write("m.obj", tetrahedron);
    write("n.nff", "");
    write("t.vera", "");
    write("a.vera", "INCLUDE \"m.obj\"\nINCLUDE \"n.nff\"\nMESH \"t.vera\"\nINCLUDE \".\"");
    EXPECT_EQ(
        said("a.vera"),
        "a.vera:1:9: error: 'm.obj' is not a text in the scene language\n"
        "    INCLUDE \"m.obj\"\n"
        "            ^~~~~~~\n"
        "  MESH reads meshes\n"
        "a.vera:2:9: error: 'n.nff' is not a text in the scene language\n"
        "    INCLUDE \"n.nff\"\n"
        "            ^~~~~~~\n"
        "  scenes in NFF are read only by themselves\n"
        "a.vera:3:6: error: 't.vera' is not a mesh\n"
        "    MESH \"t.vera\"\n"
        "         ^~~~~~~~\n"
        "  MESH reads .obj, .ply and .stl files, INCLUDE texts in the scene language\n"
        "a.vera:4:9: error: '.' is not a file\n"
        "    INCLUDE \".\"\n"
        "            ^~~\n");
}

/// Until the end of its scope the process may only do what any user may, even where tests run as
/// root, who may read everything.
class AsAnyUser {
public:
    AsAnyUser() {
        constexpr uid_t nobody = 65534;
        if (user_ == 0 && seteuid(nobody) != 0)
            std::abort();
    }

    ~AsAnyUser() {
        if (user_ == 0 && seteuid(user_) != 0)
            std::abort();
    }

    AsAnyUser(const AsAnyUser&) = delete;
    AsAnyUser& operator=(const AsAnyUser&) = delete;

private:
    uid_t user_ = geteuid();
};

TEST_F(ReadScene, TellsOfFilesThatCannotBeRead) {
    write("secret.vera", "SP 0 0 0 1");
    write("secret.obj", tetrahedron);
    std::filesystem::permissions(path("secret.vera"), std::filesystem::perms::none);
    std::filesystem::permissions(path("secret.obj"), std::filesystem::perms::none);
    std::filesystem::create_symlink("round.vera", path("round.vera"));
    write("a.vera", "INCLUDE \"secret.vera\"\nMESH \"secret.obj\"\nINCLUDE \"round.vera\"\n");
    std::string text;
    {
        const AsAnyUser as_any_user;
        text = said("a.vera");
    }
    EXPECT_EQ(
        text,
        "a.vera:1:9: error: cannot read 'secret.vera': Permission denied\n"
        "    INCLUDE \"secret.vera\"\n"
        "            ^~~~~~~~~~~~~\n"
        "a.vera:2:6: error: cannot read 'secret.obj': Permission denied\n"
        "    MESH \"secret.obj\"\n"
        "         ^~~~~~~~~~~~\n"
        "a.vera:3:9: error: cannot read 'round.vera': Too many levels of symbolic links\n"
        "    INCLUDE \"round.vera\"\n"
        "            ^~~~~~~~~~~~\n");
}

TEST_F(ReadScene, KeepsAMeshThatIsPlacedOftenOnce) {
    write("m.obj", tetrahedron);
    write("a.vera", R"(CM c MESH "m.obj" MESH "m.obj" TR 1 0 0 MESH "m.obj" SC -2 MA c)");
    EXPECT_EQ(said("a.vera"), "");
    const Scene scene = read_scene(path("a.vera")).scene;
    ASSERT_THAT(scene.geometry.items, SizeIs(3));
    EXPECT_EQ(scene.geometry.items[0].kind, ItemKind::mesh);
    EXPECT_EQ(scene.geometry.items[1].kind, ItemKind::subscene_call);
    ASSERT_THAT(scene.subscenes, SizeIs(1));
    EXPECT_EQ(scene.subscenes[0].items.at(0).material, inherited_material);
    EXPECT_EQ(scene.geometry.calls[1].subscene, scene.geometry.calls[0].subscene);
    EXPECT_EQ(scene.geometry.primitive_count, 12U);
}

TEST_F(ReadScene, TellsWhatIsWrongWithAMesh) {
    write("m.obj", "v 0 0 0\nv 1 0 x\nf 1 2 3\n");
    write("e.obj", "v 0 0 0\n");
    write("a.vera", "MESH \"m.obj\" TR 1 0 0\nMESH \"m.obj\" TR 2 0 0\nSP 0 0 y 1");
    EXPECT_THAT(said("a.vera"), HasSubstr("m.obj:2:"));
    EXPECT_THAT(said("a.vera"), HasSubstr("a.vera:3:8: error: expected the z"));
    write("b.vera", "CM c MESH \"e.obj\" SP 0 0 0 1 MA c");
    EXPECT_THAT(said("b.vera"), HasSubstr("e.obj:2:1: error: the mesh has no face"));
}

/// The blocks of a page that begin with a keyword of the language.
std::vector<std::string> examples(const std::filesystem::path& page, const std::string& keywords) {
    std::vector<std::string> blocks;
    std::ifstream file(page);
    bool inside = false;
    for (std::string line; std::getline(file, line);) {
        const bool indented = line.rfind("    ", 0) == 0;
        if (indented && !inside)
            blocks.emplace_back();
        if (indented)
            blocks.back() += line + "\n";
        inside = indented;
    }
    std::erase_if(blocks, [&](const std::string& block) {
        const std::size_t first = block.find_first_not_of(' ');
        const std::string word = block.substr(first, block.find_first_of(" \n", first) - first);
        return keywords.find(" " + word + " ") == std::string::npos;
    });
    return blocks;
}

TEST(Documentation, ShowsExamplesThatAreRight) {
    const auto blocks = examples(
        VERA_SOURCE_DIR "/docs/language.md", " PROJECTION LI P3 IP RK MESH SSC CM INCLUDE ");
    EXPECT_THAT(blocks, SizeIs(10));
    for (const std::string& block : blocks) {
        try {
            read_text(block);
        } catch (const InputError& error) {
            for (const Diagnostic& diagnostic : error.diagnostics()) {
                // Not every example defines what it uses, and two views stand side by side.
                const bool of_example = diagnostic.problem.rfind("there is no ", 0) == 0
                    || diagnostic.problem == "PROJECTION and PARALLEL are both given";
                EXPECT_TRUE(of_example || diagnostic.severity != Severity::error)
                    << to_text(diagnostic);
            }
        }
    }
}

} // namespace
} // namespace vera
