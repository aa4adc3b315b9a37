// SPDX-License-Identifier: Apache-2.0
#include "vera/math/box3.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "formats/mesh_text.h"
#include <gtest/gtest.h>
#include <unistd.h>

namespace vera {
namespace {

/// A file that is gone when the test ends.
class TemporaryFile {
public:
    TemporaryFile(const std::string& name, const std::string& text)
        : path_(
            std::filesystem::temp_directory_path()
            / ("vera_mesh_" + std::to_string(getpid()) + "_" + name)) {
        std::ofstream(path_, std::ios::binary) << text;
    }

    ~TemporaryFile() { std::filesystem::remove(path_); }

    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string ply =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
    "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
    "3 0 1 2\n";
const std::string stl =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
    "endfacet\nendsolid a\n";

TEST(ReadMesh, TellsTheFormatByTheExtensionAndElseByTheBeginning) {
    const std::pair<const char*, std::string> files[] = {
        {"a.obj", obj},
        {"a.OBJ", obj},
        {"a.ply", ply},
        {"a.Stl", stl},
        {"ply", ply},
        {"b.txt", stl}};
    for (const auto& [name, text] : files) {
        const TemporaryFile file(name, text);
        std::vector<Diagnostic> warnings;
        EXPECT_EQ(read_mesh(file.path(), warnings).triangle_count(), 1U) << name;
        EXPECT_TRUE(warnings.empty());
    }
}

TEST(ReadMesh, SaysThatItCannotTellTheFormat) {
    const TemporaryFile file("a.mesh", obj);
    std::vector<Diagnostic> warnings;
    try {
        read_mesh(file.path(), warnings);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(
            printed(error.diagnostics()),
            file.path().string()
                + ": error: neither the file's name nor its beginning says what format the mesh is "
                  "in\n  give it a name that ends in .obj, .ply or .stl\n");
    }
}

TEST(ReadMesh, NamesAFileThatIsNotThere) {
    std::vector<Diagnostic> warnings;
    EXPECT_THROW(read_mesh("no/such/file.obj", warnings), std::system_error);
}

Box3 bounds_of(const Mesh& mesh) {
    Box3 box;
    for (const Vec3& position : mesh.positions)
        box = grown(box, position);
    return box;
}

TEST(ReadMesh, ReadsSpot) {
    std::vector<Diagnostic> warnings;
    const Mesh mesh = read_mesh(VERA_SOURCE_DIR "/scenes/models/spot.obj", warnings);
    EXPECT_TRUE(warnings.empty());
    EXPECT_EQ(mesh.positions.size(), 2930U);
    EXPECT_EQ(mesh.triangle_count(), 5856U);
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_EQ(triangle(mesh, 0)[2], (Vec3{0.289638, -0.411984, 0.363044}));
    EXPECT_NEAR(length(doubled_area(mesh)), 0, 1e-12) << "a closed surface";
    EXPECT_NEAR(max_component(extent(bounds_of(mesh))), 1.9, 0.2);
}

TEST(ReadMesh, ReadsTheModelsOfOthers) {
    const char* const variable = std::getenv("VERA_MODELS");
    const std::filesystem::path folder =
        variable != nullptr ? variable : VERA_SOURCE_DIR "/../shared/models";
    const std::pair<const char*, std::size_t> models[] = {
        {"fandisk.obj", 12946},
        {"rocker-arm.obj", 20088},
        {"stanford-bunny.obj", 69451},
        {"suzanne.obj", 968},
        {"teapot.obj", 6320}};
    if (!std::filesystem::exists(folder / models[0].first))
        GTEST_SKIP() << "no models at '" << folder.string()
                     << "': set VERA_MODELS to have them read";
    for (const auto& [name, triangles] : models) {
        std::vector<Diagnostic> warnings;
        EXPECT_EQ(read_mesh(folder / name, warnings).triangle_count(), triangles) << name;
        EXPECT_EQ(printed(warnings), "") << name;
    }
}

} // namespace
} // namespace vera
