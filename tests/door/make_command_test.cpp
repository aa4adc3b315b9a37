// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "door/program.h"

namespace vera {
namespace {

bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(MakeCommand, WritesASceneAndAControlFileThatMakeAPicture) {
    const ScratchFolder folder;
    const ProgramRun made = run_vera(folder, "make balls --size 1 -o balls.vera");
    EXPECT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(made.out, "");
    EXPECT_TRUE(holds(made.err, "vera render balls.vera -c balls.ctl -o balls.png")) << made.err;
    EXPECT_EQ(folder.file_count(), 2U);
    const ProgramRun rendered =
        run_vera(folder, "render balls.vera -c balls.ctl -o balls.png --raster 16x16");
    EXPECT_EQ(rendered.exit_code, 0) << rendered.err;
    EXPECT_FALSE(holds(rendered.err, "warning")) << rendered.err;
}

TEST(MakeCommand, WritesBareModelsAndToStandardOutput) {
    const ScratchFolder folder;
    const ProgramRun run = run_vera(folder, "make tetra --size 1 --bare -o -");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err, "");
    EXPECT_EQ(std::count(run.out.begin(), run.out.end(), 'P'), 4) << run.out;
    EXPECT_FALSE(holds(run.out, "PROJECTION"));
    EXPECT_EQ(folder.file_count(), 0U);
}

TEST(MakeCommand, TellsHowMuchIsWritten) {
    const ScratchFolder folder;
    const ProgramRun run = run_vera(folder, "make tetra --size 5 -o a.vera --progress json -q");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(holds(run.err, R"("stage": "write", "done": 1.0000)")) << run.err;
    EXPECT_EQ(run_vera(folder, "make tetra --size 5 -o a.vera -q").err, "");
}

TEST(MakeCommand, ListsAndHelps) {
    const ScratchFolder folder;
    const ProgramRun list = run_vera(folder, "make --list");
    EXPECT_EQ(list.exit_code, 0);
    for (const char* name :
         {"balls", "ficus", "forest", "gear", "shell", "surface", "terrain", "tree"})
        EXPECT_TRUE(holds(list.out, name)) << name;
    const ProgramRun help = run_vera(folder, "make ficus --help");
    EXPECT_EQ(help.exit_code, 0);
    for (const char* part : {"--seed", "--dominance", "1 to 100, if not given 34", "Examples:"})
        EXPECT_TRUE(holds(help.out, part)) << part << '\n' << help.out;
    EXPECT_TRUE(holds(run_vera(folder, "make surface --help").out, "atan2, cos"));
}

TEST(MakeCommand, RunsTheExamplesOfItsHelp) {
    const ScratchFolder folder;
    for (const char* example :
         {"make balls --size 3 -o balls.vera",
          "make surface \"cos(u)*cos(v)\" \"sin(v)\" \"sin(u)*cos(v)\" --u 0 2*pi --v -pi/2 pi/2 "
          "-o ball.vera",
          "make surface u v \"sin(n*(u^2+v^2))/n\" --let n=5 --z-up --u -1 1 --v -1 1 --pixels "
          "0.5 -o waves.vera",
          "make surface -v \"-u*v\" u --u -1 1 --v -1 1 -o saddle.vera",
          "make turned 0 0 3 0 3 1 1 1 1 2 0 2 -o wheel.vera",
          "make turned 0 0 1.2 0 1.2 0 2 2 0.8 4 1.3 5 1.3 5 1.15 5 1.15 5 0.65 4 1.85 2 0 0.2 "
          "--smooth -o vase.vera"}) {
        const ProgramRun run = run_vera(folder, example);
        EXPECT_EQ(run.exit_code, 0) << example << '\n' << run.err;
    }
    EXPECT_EQ(folder.file_count(), 12U);
}

TEST(MakeCommand, TakesFormulasThatBeginWithAMinus) {
    const ScratchFolder folder;
    const auto made = [&](const char* formulas) {
        return run_vera(folder, std::string("make surface --bare -o - ") + formulas).out;
    };
    const std::string brackets = made("\"(-u)\" v \"(-cos(v))\"");
    EXPECT_FALSE(brackets.empty());
    EXPECT_EQ(made("-u v \"-cos(v)\""), brackets);
    EXPECT_EQ(made("-- -u v \"-cos(v)\""), brackets);
}

TEST(MakeCommand, WritesTurnedShapesThatReadWithoutAWarning) {
    const ScratchFolder folder;
    ASSERT_EQ(
        run_vera(
            folder,
            "make turned 0 -1 1.2 -1 1.2 -1 2 2 0.8 4 1.3 5 1.3 5 0 5 --smooth -o vase.vera")
            .exit_code,
        0);
    EXPECT_TRUE(holds(folder.read("vase.vera"), "KU"));
    const ProgramRun checked = run_vera(folder, "check vase.vera --strict");
    EXPECT_EQ(checked.out, "vase.vera: good\n") << checked.err;
}

TEST(MakeCommand, SaysWhatIsWrong) {
    const ScratchFolder folder;

    const struct {
        const char* arguments;
        int exit_code;
        const char* problem;
    } wrong[] = {
        {"make", 2, "say what to make; 'vera make --list' shows what there is"},
        {"make fucus -o a.vera", 2, "unknown command 'fucus'; did you mean 'ficus'?"},
        {"make balls --sise 3 -o a.vera",
         2,
         "unknown option '--sise'; did you mean '--size'? ('vera make balls --help'"},
        {"make balls --size 99 -o a.vera",
         2,
         "--size of balls is 99, but must be a whole number from 0 to 12"},
        {"make balls --size x -o a.vera", 2, "takes a number; found 'x'"},
        {"make balls --size 2 --size 3 -o a.vera",
         2,
         "--size is given 2 times, with '2' and '3'; give it once"},
        {"make balls", 2, "-o SCENE is missing; write vera make balls -o SCENE"},
        {"make nothing at all", 2, "unknown command 'nothing'; it is one of "},
        {"make surface u v 0 --u 0 1 2 -o a.vera",
         2,
         "--u FROM TO (range of u; numbers or formulas; if not given 0 1) takes 2 values; found 3: "
         "'0', '1' and '2'"},
        {"make surface u v -o a.vera", 2, "Z is missing; write vera make surface X Y Z -o SCENE"},
        {"make surface u v u\u00d7v -o a.vera",
         1,
         "Z:1:2: error: expected an operator, found '\u00d7'\n    u\u00d7v\n     ^\n"},
        {"make surface u v \"$(printf 'u\\377v')\" -o a.vera",
         1,
         "Z:1:2: error: expected an operator, found a byte that is not UTF-8"},
        {"make balls -o a.png",
         2,
         "'a.png' is no name of a scene text; take one that ends in .vera"},
        {"make balls -o gone/a.vera", 3, "gone/a.vera"},
        {"make surface u v \"2 * sine(u)\" -o a.vera",
         1,
         "Z:1:5: error: there is no 'sine'; did you mean 'sin'?\n    2 * sine(u)\n        ^~~~"},
        {"make surface u v 1/u --u -1 1 -o a.vera",
         1,
         "surface: error: z has no finite value at u = 0"},
        {"make surface u v \"log(-1)\" -o a.vera",
         1,
         "surface: error: z has a finite value nowhere"},
        {"make surface u u u -o a.vera", 1, "surface: error: the surface has no area"},
        {"make surface u 1e9+v u*v -o a.vera", 1, "surface: error: numbers near 1e+09 are rounded"},
        {"make surface -sine\\(u\\) v u -o a.vera",
         1,
         "X:1:2: error: there is no 'sine'; did you mean 'sin'?\n    -sine(u)\n     ^~~~"},
        {"make surface u v u -w 3 -o a.vera", 2, "unknown option '-w'"},
        {"make turned 0 0 1 -o a.vera", 2, "the profile has 3 numbers, but is made of pairs"},
        {"make turned 0 0 -o a.vera", 2, "a profile has at least two points"},
        {"make turned 1 -3 -1 0 -o a.vera", 2, "point 2 of the profile is at -1 0"},
        {"make turned 0 0 0 1 -o a.vera", 2, "on the axis; give a distance from it"},
        {"make turned 0 0 nan 1 -o a.vera", 2, "point 2 of the profile"},
        {"make turned -o a.vera",
         2,
         "R H R H ... is missing; write vera make turned R H R H ... -o SCENE"},
        {"make balls --size 2 --size 3 -o a.vera",
         2,
         "--size is given 2 times, with '2' and '3'; give it once"},
        {"make surface u v u*v --u 1 1 -o a.vera", 2, "--u goes from 1 to 1"},
        {"make surface u v u --let u=1 -o a.vera",
         1,
         "--let:1:1: error: 'u' has a meaning already"},
        {"make surface u v \"sin(99*u)\" --deviation 1e-9 -o a.vera",
         1,
         "triangles, and 2000000 are allowed\n  allow a larger deviation (--deviation), or "
         "--most-triangles"},
        {"make surface u v u --deviation 1 --pixels 1 -o a.vera", 2, "exclude each other"},
        {"make surface u v u --deviation -1 -o a.vera", 2, "--deviation takes a number from"},
        {"make surface u v u --deviation nan -o a.vera", 2, "--deviation takes a number from"},
    };

    for (const auto& [arguments, exit_code, problem] : wrong) {
        const ProgramRun run = run_vera(folder, arguments);
        EXPECT_EQ(run.exit_code, exit_code) << arguments << '\n' << run.err;
        EXPECT_TRUE(holds(run.err, problem)) << arguments << '\n' << run.err;
    }
    EXPECT_EQ(folder.file_count(), 0U);
}

} // namespace
} // namespace vera
