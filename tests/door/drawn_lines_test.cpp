// SPDX-License-Identifier: Apache-2.0
// The lines that `vera draw` draws.
#include <algorithm>
#include <string>
#include <vector>

#include "door/program.h"
#include "door/svg_text.h"

namespace vera {
namespace {

/// A hill that stands in a floor which goes to the horizon: for the breadth of a facet the floor
/// comes before the hill within a step of an edge that it is cut by, so that nothing of either
/// parts them there.
TEST(DrawCommand, DrawsALineWhereThingsPassThroughEachOtherWithoutAGap) {
    const ScratchFolder folder;
    folder.write(
        "hill.vera",
        "PROJECTION 2.20 1.30 17.00  -2.24 -0.15 0.20  2.42 -0.15 -0.38  -2.22 4.15 0.38\n"
        "CM grass  P4 -400 0 -600  -400 0 60  400 0 60  400 0 -600\n"
        "CM hill   RS -90 -18 -260  V 0 1 0  AN 120 0  KE 60 44 0.6  0 44\n"
        "MA grass  DRF 0.3 0.4 0.1\n"
        "MA hill   DRF 0.2 0.3 0.2\n");
    const ProgramRun run = run_vera(folder, "draw hill.vera -o hill.svg --style lines");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const std::string svg = folder.read("hill.svg");
    const std::size_t group = svg.find("<g id=\"intersection-lines\"");
    ASSERT_NE(group, std::string::npos);
    const std::string lines = svg.substr(group, svg.find("</g>", group) - group);
    EXPECT_EQ(count_of(lines, "<path"), 1U) << lines;
}

TEST(DrawCommand, DrawsSilhouettesAndCreasesAsLayersOfLines) {
    const ScratchFolder folder;
    // Two walls that meet at a right angle.
    folder.write(
        "a.vera", view + "P4 -1 1 0  0 1 1  0 3 1  -1 3 0\nP4 0 1 1  1 1 0  1 3 0  0 3 1\n");
    const ProgramRun run = run_vera(folder, "draw a.vera --style lines -o a.svg");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const std::string svg = folder.read("a.svg");
    EXPECT_TRUE(holds(
        svg,
        "<g id=\"silhouette-lines\" class=\"line silhouette-lines\" "
        "inkscape:groupmode=\"layer\" inkscape:label=\"Silhouette lines\">"))
        << svg;
    EXPECT_TRUE(holds(svg, "<g id=\"crease-lines\" class=\"line crease-lines\"")) << svg;
    EXPECT_FALSE(holds(svg, "fill=\"")) << svg;
    EXPECT_EQ(count_of(svg, "<path "), 2U) << svg;
}

TEST(DrawCommand, DashesWhatIsHiddenAndDrawsLinesAsAsked) {
    const ScratchFolder folder;
    // A wall before half of another.
    folder.write(
        "a.vera",
        view + "P4 -1 1 1  0 1 1  0 3 1  -1 3 1\nP4 -1 1.5 0  1 1.5 0  1 2.5 0  -1 2.5 0\n");
    const std::string command =
        "draw a.vera -o a.svg --line silhouette:width=3 --line hidden:color=#c08000,dash=5-2.5 "
        "--line silhouette:color=#123 --style ";
    const ProgramRun run = run_vera(folder, command + "hidden-lines");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const std::string svg = folder.read("a.svg");
    EXPECT_TRUE(holds(svg, ".silhouette-lines{stroke:#123;stroke-width:3}\n")) << svg;
    EXPECT_TRUE(holds(
        svg,
        ".hidden-lines{stroke:#c08000;stroke-width:.5;stroke-linecap:butt;"
        "stroke-dasharray:5 2.5}\n"))
        << svg;
    const std::size_t hidden = svg.find("<g id=\"hidden-lines\"");
    ASSERT_NE(hidden, std::string::npos) << svg;
    EXPECT_LT(hidden, svg.find("<g id=\"silhouette-lines\"")) << svg;
    ASSERT_EQ(run_vera(folder, command + "lines").exit_code, 0);
    EXPECT_FALSE(holds(folder.read("a.svg"), "hidden-lines")) << folder.read("a.svg");
}

TEST(DrawCommand, DrawsACartoonInThreeTonesWithLinesOnTop) {
    const ScratchFolder folder;
    folder.write("a.vera", view + "SP 0 2 0 1.5\n");
    const ProgramRun run = run_vera(folder, "draw a.vera --style toon --deviation 1 -o a.svg");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const std::string svg = folder.read("a.svg");
    std::vector<std::string> colors = of_outlines(svg, "fill");
    ASSERT_GT(colors.size(), 20U);
    colors.erase(colors.begin()); // what lies below them
    std::sort(colors.begin(), colors.end());
    colors.erase(std::unique(colors.begin(), colors.end()), colors.end());
    // 0.35, 0.65 and 1 of 0.7.
    EXPECT_EQ(colors, (std::vector<std::string>{"#3e3e3e", "#747474", "#b3b3b3"})) << svg;
    EXPECT_LT(svg.find("<g id=\"fills\""), svg.find("<g id=\"silhouette-lines\"")) << svg;
}

TEST(DrawCommand, DrawsASphereAsOneClosedLine) {
    const ScratchFolder folder;
    folder.write("a.vera", view + "SP 0 2 0 1.5\n");
    const ProgramRun run = run_vera(folder, "draw a.vera --style lines --deviation 1 -o a.svg");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const std::string svg = folder.read("a.svg");
    EXPECT_EQ(count_of(svg, "<path "), 1U) << svg;
    EXPECT_TRUE(holds(svg, "z\"/>")) << svg;
}

TEST(DrawCommand, DrawsNoLinesWhereTheFrameCutsASurface) {
    const ScratchFolder folder;
    folder.write("a.vera", view + "P4 -9 0 9  9 0 9  9 0 -9  -9 0 -9\n");
    const ProgramRun run = run_vera(folder, "draw a.vera --style lines --precision 1 -o a.svg");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const std::string svg = folder.read("a.svg");
    EXPECT_EQ(count_of(svg, "<path "), 1U) << svg;
    EXPECT_TRUE(holds(svg, "<path d=\"m0 376h512\"/>") || holds(svg, "<path d=\"m512 376h-512\"/>"))
        << svg;
}

} // namespace
} // namespace vera
