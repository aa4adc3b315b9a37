// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "door/program.h"
#include <gmock/gmock.h>

namespace vera {
namespace {

using ::testing::HasSubstr;

TEST(BenchFigure, ListsAndDrawsEachFigure) {
    const ScratchFolder folder;
    const ProgramRun list = run_vera(folder, "bench figure --list");
    EXPECT_EQ(list.exit_code, 0);
    for (const char* name : {"3a", "3b", "3c", "3d", "A1", "A2", "B1"}) {
        EXPECT_THAT(list.out, HasSubstr(std::string(name) + "   ")) << name;
        const ProgramRun run =
            run_vera(folder, std::string("bench figure ") + name + " -o " + name + ".svg");
        EXPECT_EQ(run.exit_code, 0) << run.err;
        EXPECT_THAT(run.err, HasSubstr(std::string("figure ") + name + ": ")) << name;
        EXPECT_THAT(folder.read(std::string(name) + ".svg"), HasSubstr("</svg>")) << name;
    }
    const ProgramRun small = run_vera(folder, "bench figure a1 -o - -q");
    EXPECT_EQ(small.out, folder.read("A1.svg"));
    EXPECT_EQ(small.err, "");
}

TEST(BenchFigure, SaysWhatIsWrongWithACommandLine) {
    const ScratchFolder folder;

    const struct {
        const char* arguments;
        const char* problem;
    } wrong[] = {
        {"", "name a figure; 'vera bench figure --list' tells which there are"},
        {"3e -o a.svg", "there is no figure '3e'; there are 3a, 3b, 3c, 3d, A1, A2 and B1"},
        {"3a", "--output is required: the file to draw into"},
        {"3a -o a.png", "'a.png' is no name of an SVG: figures are written as .svg"},
        {"3a -o a.svgg", "did you mean 'a.svg'?"},
        {"3a --list", "--list only names the figures: give it alone"},
    };

    for (const auto& [arguments, problem] : wrong) {
        const ProgramRun run = run_vera(folder, std::string("bench figure ") + arguments);
        EXPECT_EQ(run.exit_code, 2) << arguments;
        EXPECT_THAT(run.err, HasSubstr(problem)) << arguments;
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    }
    EXPECT_EQ(folder.file_count(), 0U);
}

} // namespace
} // namespace vera
