// SPDX-License-Identifier: Apache-2.0
#include "vera/image/image_file.h"

#include "door/program.h"

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
