// SPDX-License-Identifier: Apache-2.0
#include "vera/image/image_file.h"

#include "door/program.h"
#include "door/svg_text.h"
#include <nlohmann/json.hpp>

namespace vera {
namespace {

TEST(InfoCommand, TellsWhatASceneHoldsAndItsIndexes) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    const ProgramRun run = run_vera(folder, "info a.vera");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    for (const char* part :
         {"primitives",
          "spheres",
          "bounds",
          "lights",
          "hierarchy of boxes",
          "nodes",
          "grid",
          "cells",
          "memory"})
        EXPECT_NE(run.out.find(part), std::string::npos) << part << '\n' << run.out;
}

TEST(InfoCommand, TellsTheSameAsJson) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    const ProgramRun run = run_vera(folder, "info a.vera --json");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    for (const char* part :
         {"\"primitives\": 2", "\"spheres\": 1", "\"polygons\": 1", "\"bvh\"", "\"grid\""})
        EXPECT_NE(run.out.find(part), std::string::npos) << part << '\n' << run.out;
}

TEST(InfoCommand, ListsObjectsAndGroupsOfObjFiles) {
    const ScratchFolder folder;
    folder.write(
        "a.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib a.mtl\nf 1 2 3\no caf\xE9\nusemtl red\nf 1 2 3\ng b c\n"
        "usemtl blue\nf 1 2 3\nusemtl red\nf 1 2 3\no d\nf 1 2 3\n");
    folder.write("a.mtl", "newmtl red\nnewmtl blue\n");
    const ProgramRun text = run_vera(folder, "info a.obj");
    ASSERT_EQ(text.exit_code, 0) << text.err;
    EXPECT_NE(
        text.out.find("named parts         3\n"
                      "  'caf\\xe9', 3 primitives from 2 on, 'red', 'blue'\n"
                      "    'b c', 2 primitives from 3 on, 'blue', 'red'\n"
                      "  'd', 1 primitive from 5 on, 'red'\n"),
        std::string::npos)
        << text.out;
    const ProgramRun run = run_vera(folder, "info a.obj --json");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    const nlohmann::json parts = {
        {{"name", "caf\xEF\xBF\xBD"},
         {"first_primitive", 2},
         {"primitives", 3},
         {"materials", {"red", "blue"}},
         {"parts",
          {{{"name", "b c"},
            {"first_primitive", 3},
            {"primitives", 2},
            {"materials", {"blue", "red"}}}}}},
        {{"name", "d"}, {"first_primitive", 5}, {"primitives", 1}, {"materials", {"red"}}}};
    EXPECT_EQ(json["named_parts"], parts);
    // Of a scene that has the mesh, within its subscene.
    folder.write("a.vera", view + "MESH \"a.obj\" TR 1 0 0\n");
    const auto called = nlohmann::json::parse(run_vera(folder, "info a.vera --json").out);
    EXPECT_EQ(called["named_parts"][0]["subscene"], "a.obj");
    EXPECT_EQ(called["named_parts"][1]["name"], "d");
    EXPECT_EQ(called["named_parts"][1]["first_primitive"], 5);
    // A hundred are enough for people.
    std::string many = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int i = 0; i < 103; ++i)
        many += "o part" + std::to_string(i) + "\nf 1 2 3\n";
    folder.write("many.obj", many);
    const ProgramRun told = run_vera(folder, "info many.obj");
    EXPECT_NE(
        told.out.find("  'part99', 1 primitive from 100 on\n  and 3 more, which --json tells\n"),
        std::string::npos)
        << told.out;
}

TEST(InfoCommand, DrawsTheTreeOfGridsWithALegend) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    const ProgramRun run = run_vera(folder, "info a.vera --draw-grid a.svg --raster 200x150");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.err.find("a.svg: level 1: 1 grid of "), std::string::npos) << run.err;
    const std::string svg = folder.read("a.svg");
    for (const char* part : {"id=\"legend\"", "level 1: 1 grid of ", "<path", "</svg>"})
        EXPECT_NE(svg.find(part), std::string::npos) << part;
    ASSERT_EQ(
        run_vera(folder, "info a.vera -q --draw-grid a.png --grid-cut 0.5 --raster 60x40")
            .exit_code,
        0);
    EXPECT_EQ(read_image(folder.path() / "a.png").width, 60U);
}

TEST(InfoCommand, RefusesPicturesOfTheGridThatItCannotMake) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);

    const struct {
        const char* options;
        const char* problem;
    } wrong[] = {
        {"--draw-grid a.pdf", "--draw-grid writes SVG and PNG; found 'a.pdf'"},
        {"--grid-levels 2", "--grid-levels is without effect alone; give --draw-grid PICTURE too"},
        {"--draw-grid a.svg --grid-levels 0", "--grid-levels"},
        {"--draw-grid a.svg --grid-cut 1", "--grid-cut"},
        {"--draw-grid a.svg --grid-from 9", "no cell of level 9 or deeper is left to draw"},
    };

    for (const auto& [options, problem] : wrong) {
        const ProgramRun run = run_vera(folder, std::string("info a.vera ") + options);
        EXPECT_EQ(run.exit_code, 2) << options;
        EXPECT_NE(run.err.find(problem), std::string::npos) << run.err;
    }
    EXPECT_EQ(folder.file_count(), 1U);
}

} // namespace
} // namespace vera
