// SPDX-License-Identifier: Apache-2.0
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

} // namespace
} // namespace vera
