// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "door/program.h"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace vera {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::size_t lines_of(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST(BenchCurve, ListsEachCurveWithItsInput) {
    const ScratchFolder folder;
    const ProgramRun run = run_vera(folder, "bench curve --list");
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.out, HasSubstr("conjugation-tree/circle          points on a circle\n"));
    EXPECT_GT(lines_of(run.out), 15U);
}

TEST(BenchCurve, PrintsATableAndWritesPointsAndAPlot) {
    const ScratchFolder folder;
    const ProgramRun run = run_vera(
        folder, "bench curve kd-tree conjugation-tree/circle --largest 512 -o a.csv -o a.svg -q");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err, "");
    // Two tables of three curves, with an empty line and a heading between.
    EXPECT_EQ(lines_of(run.out), 4U + 2 + 4) << run.out;
    EXPECT_THAT(run.out, HasSubstr("by a bootstrap"));
    EXPECT_THAT(run.out, HasSubstr("above the bound for certain"));
    EXPECT_THAT(run.out, HasSubstr(" c n^1.00\n")); // boxes along a thin diagonal
    EXPECT_EQ(folder.read("a.csv").substr(0, 36), "curve,size,count,bound,local_exponen");
    EXPECT_EQ(lines_of(folder.read("a.csv")), 1U + 3 * 7);
    EXPECT_THAT(folder.read("a.svg"), HasSubstr("kd-tree"));
    EXPECT_EQ(folder.file_count(), 2U);
}

TEST(BenchCurve, TellsAllAsJson) {
    const ScratchFolder folder;
    const ProgramRun run =
        run_vera(folder, "bench curve visible-sweep/grate --sizes 32,48,64,96,128 --seed 3 --json");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["version"], 1);
    EXPECT_EQ(json["seed"], 3);
    const auto& curve = json["curves"].at(0);
    EXPECT_EQ(curve["sizes"], (std::vector<double>{32, 48, 64, 96, 128}));
    EXPECT_EQ(curve["local_exponents"].size(), 4U);
    EXPECT_EQ(curve["first_fitted"], 48);
    // Each sliver of a bundle crosses each of the other one.
    EXPECT_NEAR(curve["exponent"], 2, 0.1);
    EXPECT_NE(curve["verdict"], "above");
    EXPECT_LE(curve["bootstrap_interval"].at(0), curve["exponent"]);
    EXPECT_GE(curve["bootstrap_interval"].at(1), curve["exponent"]);
    EXPECT_EQ(curve["bootstrap_verdict"], curve["verdict"]);
    EXPECT_EQ(curve["models"].size(), 4U);
    EXPECT_EQ(curve["models"].at(2)["formula"], curve["follows"]);
    EXPECT_EQ(curve["models"].at(2)["aic_above_best"], 0);
    EXPECT_EQ(curve["variables"]["n"], (std::vector<double>{96, 144, 192, 288, 384}));
    // 16 slivers of either bundle, both long sides of each; but for one crossing, at a common end.
    EXPECT_EQ(curve["variables"]["k"].at(0), 4 * 16 * 16 - 1);
    const auto& structure = json["structures"].at(0);
    EXPECT_EQ(structure["terms"], (std::vector<std::string>{"n log n", "k log n"}));
    EXPECT_EQ(structure["families"].at(0)["family"], "grate");
    EXPECT_GT(structure["families"].at(0)["coefficients"].at(1)["value"], 0.5);
    EXPECT_TRUE(structure["one_for_all"].at(0).is_null());
}

TEST(BenchCurve, ComparesTheTermsOfABoundAcrossFamilies) {
    const ScratchFolder folder;
    const ProgramRun run = run_vera(
        folder,
        "bench curve visible-sweep/grate visible-terrain --sizes 32,64,128,256 -o a.csv -q");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("\nTerms: visible-sweep as c1 n log n + c2 k log n\n  grate "));
    EXPECT_THAT(
        run.out, HasSubstr("\nTerms: visible-terrain as c1 n log^2 n + c2 v log^2 n\n  steep "));
    EXPECT_THAT(run.out, HasSubstr("\n  one for all "));
    EXPECT_THAT(
        folder.read("a.csv"), StartsWith("curve,size,count,bound,local_exponent,fitted,n,k,v\n"));
    EXPECT_THAT(folder.read("a.csv"), HasSubstr(",1,96,1023,\n"));
}

TEST(BenchCurve, IsTheSameFromRunToRun) {
    const ScratchFolder folder;
    for (const char* name : {"a.svg", "b.svg"})
        ASSERT_EQ(
            run_vera(folder, std::string("bench curve prop1-memory --largest 256 -o ") + name)
                .exit_code,
            0);
    EXPECT_EQ(folder.read("a.svg"), folder.read("b.svg"));
    const ProgramRun points = run_vera(folder, "bench curve prop1-memory --largest 256 -o -");
    EXPECT_THAT(points.out, StartsWith("curve,size,"));
}

TEST(BenchCurve, SaysWhatIsWrongWithACommandLine) {
    const ScratchFolder folder;

    const struct {
        const char* arguments;
        const char* problem;
    } wrong[] = {
        {"", "name a curve, or all; 'vera bench curve --list' names them"},
        {"conjugaton-tree",
         "there is no curve 'conjugaton-tree'; did you mean 'conjugation-tree'?"},
        {"kd-tree --list", "--list only names the curves: give it alone"},
        {"kd-tree --largest 100",
         "kd-tree/scattered is counted at 2 sizes, and an exponent takes 4"},
        {"kd-tree --sizes 8,16,32", "is counted at 3 sizes"},
        {"kd-tree --sizes 8,32,16,64",
         "the size 16 stands behind 32: name sizes in ascending order"},
        {"kd-tree --sizes 8,9.5,10,11", "--sizes takes a whole number from 2 to"},
        {"kd-tree --sizes 8,16,32,64 --largest 64",
         "--sizes names every size: leave out --largest"},
        {"kd-tree --sizes 8,16,32,900000000", "kd-tree/scattered takes at most 4194304 points"},
        {"kd-tree --seed -1", "--seed takes a whole number from 0"},
        {"kd-tree -o a.txt", "'a.txt' tells no format: curves are written as .csv or .svg"},
        {"kd-tree -o a.cvs", "did you mean 'a.csv'?"},
        {"kd-tree -o a.csv -o a.csv", "'a.csv' is named twice: leave out one"},
        {"kd-tree -o - --json", "--json and '-o -' would both write to standard output"},
    };

    for (const auto& [arguments, problem] : wrong) {
        const ProgramRun run = run_vera(folder, std::string("bench curve ") + arguments);
        EXPECT_EQ(run.exit_code, 2) << arguments;
        EXPECT_EQ(run.out, "") << arguments;
        EXPECT_THAT(run.err, HasSubstr(problem)) << arguments;
        EXPECT_EQ(lines_of(run.err), 1U) << run.err;
    }
    EXPECT_EQ(folder.file_count(), 0U);
}

TEST(BenchCurve, LeavesNothingWhenItIsInterrupted) {
    const ScratchFolder folder;
    const ProgramRun run = run_vera(
        folder,
        "bench curve conjugation-tree --largest 1000000 -o a.svg & child=$!; sleep 1; "
        "kill -INT $child; wait $child");
    EXPECT_EQ(run.exit_code, 130) << run.err;
    EXPECT_EQ(run.err, "vera: interrupted\n");
    EXPECT_EQ(folder.file_count(), 0U);
}

} // namespace
} // namespace vera
