// SPDX-License-Identifier: Apache-2.0
// The faces that `vera draw` draws.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "door/program.h"
#include "door/svg_text.h"

namespace vera {
namespace {

TEST(DrawCommand, GivesEachPrimitiveItsNumberForColourInTheOrderOfTheText) {
    const ScratchFolder folder;
    folder.write(
        "a.vera",
        view
            + "P4 -9 0 9  9 0 9  9 0 -9  -9 0 -9\n"
              "SP -1 1 0 0.5\n"
              "P3 0 1 0  1 1 0  0 2 0\n"
              "SSC pair TR 1 2 0\n"
              "SCENE pair\n"
              "SP 0 0 0 0.3\n"
              "SP 0 1 0 0.3\n");
    const ProgramRun run = run_vera(folder, "draw a.vera --style ids -o a.svg");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const std::string svg = folder.read("a.svg");
    const std::vector<std::string> colors = {"#000001", "#000002", "#000003", "#000004", "#000005"};
    EXPECT_EQ(of_outlines(svg, "fill"), colors) << svg;
    EXPECT_TRUE(holds(svg, "<rect id=\"background\" width=\"512\" height=\"512\" fill=\"#000\"/>"));
    // Nothing else, so that the file stays small.
    EXPECT_FALSE(holds(svg, "seam")) << svg;
    EXPECT_FALSE(holds(svg, "underlay")) << svg;
    EXPECT_FALSE(holds(svg, "<path id")) << svg;
    EXPECT_FALSE(holds(svg, "line 6")) << svg;
}

TEST(DrawCommand, GroupsFacesOfObjFilesByTheirNames) {
    const ScratchFolder folder;
    // Of the two squares in one plane each is a face, as they are of two groups.
    folder.write(
        "a.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\no a \"chair\"\ng seat <1>\n"
        "f 1 2 3 4\ng back\nf 2 5 6 3\n");
    ASSERT_EQ(run_vera(folder, "draw a.obj -o a.svg").exit_code, 0);
    const std::string svg = folder.read("a.svg");
    for (const char* part :
         {"<g id=\"object-1\" data-name=\"a &quot;chair&quot;\" "
          "inkscape:label=\"a &quot;chair&quot;\">\n<title>a &quot;chair&quot;</title>\n"
          "<g id=\"part-1\" data-name=\"seat &lt;1&gt;\" inkscape:label=\"seat &lt;1&gt;\">\n",
          "<path id=\"face-1\"",
          "</g>\n<g id=\"part-3\" data-name=\"back\" inkscape:label=\"back\">\n",
          "<path id=\"face-3\""})
        EXPECT_TRUE(holds(svg, part)) << part << '\n' << svg;
    EXPECT_EQ(count_of(svg, "<path id=\"face-"), 2U) << svg;
    // In a scene within the mesh, whether that has a material or is placed.
    folder.write("b.vera", view + "MESH \"a.obj\"\nMESH \"a.obj\" TR -2 1 0\n");
    ASSERT_EQ(run_vera(folder, "draw b.vera -o b.svg").exit_code, 0);
    const std::string scene = folder.read("b.svg");
    for (const char* part :
         {"<g id=\"object-1\" data-name=\"a.obj\" inkscape:label=\"a.obj\">\n",
          "<g id=\"part-1\" data-name=\"a &quot;chair&quot;\" ",
          "<g id=\"group-3\" class=\"material-grey\" data-material=\"grey\" data-name=\"back\" ",
          "<g id=\"object-5\" inkscape:label=\"a.obj, line 6\">\n",
          "<g id=\"part-5\" data-name=\"a &quot;chair&quot;\" ",
          "<g id=\"group-7\" class=\"material-grey\" data-material=\"grey\" data-name=\"back\" "})
        EXPECT_TRUE(holds(scene, part)) << part << '\n' << scene;
    // Each triangle has its number in style ids, and lines go round no part.
    ASSERT_EQ(run_vera(folder, "draw a.obj --style ids -o ids.svg").exit_code, 0);
    EXPECT_EQ(of_outlines(folder.read("ids.svg"), "fill").size(), 4U);
    ASSERT_EQ(run_vera(folder, "draw a.obj --style lines -o lines.svg").exit_code, 0);
    EXPECT_FALSE(holds(folder.read("lines.svg"), "crease"));
}

TEST(DrawCommand, NamesFacesByTheirStatementsAndLaysWhatHangsTogetherBelowThem) {
    const ScratchFolder folder;
    // Two walls that meet, one of them of a subscene, and one by itself.
    folder.write(
        "a.vera",
        view
            + "P4 -1 1 0  0 1 1  0 3 1  -1 3 0\n"
              "P3 1.2 1 0  1.9 1 0  1.2 2 0\n"
              "SSC wall\n"
              "SCENE wall\n"
              "P4 0 1 1  1 1 0  1 3 0  0 3 1\n");
    const ProgramRun run = run_vera(folder, "draw a.vera -o a.svg");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const std::string svg = folder.read("a.svg");
    const std::vector<std::string> ids = {"underlay", "face-1", "face-2", "face-3"};
    EXPECT_EQ(of_outlines(svg, "id"), ids) << svg;
    EXPECT_TRUE(holds(svg, "<title>polygon, line 5</title>")) << svg;
    EXPECT_TRUE(holds(svg, "<title>polygon of wall, line 9</title>")) << svg;
}

TEST(DrawCommand, ShadesWithGradientsWithinATolerance) {
    const ScratchFolder folder;
    folder.write("a.vera", view + "P4 -9 0 9  9 0 9  9 0 -9  -9 0 -9\nSP -1 1 0 0.9\n");
    const std::string command =
        "draw a.vera --style shaded --sky 0.2 0.3 0.9 --horizon 1 1 1 --earth 0 0 0";
    ASSERT_EQ(run_vera(folder, command + " -o a.svg").exit_code, 0);
    ASSERT_EQ(run_vera(folder, command + " --color-tolerance 8 -o b.svg").exit_code, 0);
    const std::string fine = folder.read("a.svg");
    const std::string coarse = folder.read("b.svg");
    EXPECT_TRUE(holds(fine, "<g id=\"sky\"")) << fine;
    EXPECT_TRUE(holds(fine, "<linearGradient id=\"g1\" gradientUnits=\"userSpaceOnUse\"")) << fine;
    EXPECT_TRUE(holds(fine, " fill=\"url(#g1)\"")) << fine;
    EXPECT_FALSE(holds(fine, "seam")) << fine;
    // A sphere is shaded as a whole, not facet by facet.
    EXPECT_LT(count_of(coarse, "<path id=\"face-2"), 60U);
    EXPECT_LT(2 * count_of(coarse, "<path "), count_of(fine, "<path "));
    ASSERT_EQ(run_vera(folder, command + " -o a.pdf").exit_code, 0);
    EXPECT_TRUE(holds(folder.read("a.pdf"), "/Pattern<</P0 "));
    ASSERT_EQ(run_vera(folder, command + " -o a.eps").exit_code, 0);
    EXPECT_TRUE(holds(folder.read("a.eps"), "%%LanguageLevel: 3\n"));
}

TEST(DrawCommand, DrawsAnEmptySceneAsItsBackground) {
    const ScratchFolder folder;
    folder.write("a.vera", "PROJECTION 0 2 8  -2 0 0  2 0 0  -2 4 0\n");
    const std::string command = "draw a.vera --raster 40x30 --earth 1 1 1 --sky 1 1 1 -o ";
    for (const char* rest :
         {"a.svg", "a.pdf", "a.eps", "b.svg --style lines", "c.svg --style ids"}) {
        const ProgramRun run = run_vera(folder, command + rest);
        EXPECT_EQ(run.exit_code, 0) << rest << '\n' << run.err;
        EXPECT_TRUE(holds(run.err, ": 0 faces seen of 0 facets; ")) << run.err;
    }
    EXPECT_TRUE(holds(
        folder.read("a.svg"),
        "<rect id=\"background\" width=\"40\" height=\"30\" fill=\"#fff\"/>\n</svg>\n"));
    EXPECT_TRUE(folder.read("a.pdf").ends_with("%%EOF\n"));
    EXPECT_TRUE(folder.read("a.eps").ends_with("%%EOF\n"));
    EXPECT_FALSE(holds(folder.read("b.svg"), "<rect"));
    EXPECT_TRUE(folder.read("b.svg").ends_with("</desc>\n</svg>\n"));
}

TEST(DrawCommand, CutsWhatPassesThroughOtherThings) {
    const ScratchFolder folder;
    folder.write("a.vera", view + "P4 -9 0 9  9 0 9  9 0 -9  -9 0 -9\nSP 0 0.2 -4 1\n");
    const ProgramRun run = run_vera(folder, "draw a.vera --style ids -o a.svg --json");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err, "");
    EXPECT_FALSE(holds(run.out, "\"cut_rounds\": 0,")) << run.out;
    EXPECT_TRUE(holds(run.out, "\"penetrating\": 0,")) << run.out;
    const std::string svg = folder.read("a.svg");
    const std::vector<std::string> colors = {"#000001", "#000002"};
    EXPECT_EQ(of_outlines(svg, "fill"), colors) << svg;
    // Half of the ball at least: more points than an outline of straight sides has.
    EXPECT_GT(of_outlines(svg, "d").back().size(), 300U) << svg;
}

TEST(DrawCommand, SaysWhatIsTooNearToBeDrawn) {
    const ScratchFolder folder;
    const std::string far = "P4 -9 0 9  9 0 9  9 0 -4000  -9 0 -4000\n";
    folder.write("far.vera", view + far);
    folder.write(
        "near.vera", view + far + "P3 -1 1.999 7.99999  1 1.999 7.99999  0 2.001 7.99999\n");
    const ProgramRun all = run_vera(folder, "draw far.vera --style ids -o a.svg");
    ASSERT_EQ(all.exit_code, 0) << all.err;
    EXPECT_FALSE(holds(all.err, "not drawn")) << all.err;
    const ProgramRun run = run_vera(folder, "draw near.vera --style ids -o b.svg");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(holds(
        run.err,
        "what is nearer to the view point than 0.00764 of the image plane's "
        "distance is not drawn: the rest would be too coarse"))
        << run.err;
    EXPECT_EQ(of_outlines(folder.read("b.svg"), "fill"), std::vector<std::string>{"#000001"});
}

TEST(DrawCommand, WarnsOnceOfWhatLetsLightThrough) {
    const ScratchFolder folder;
    const std::string face = "P3 -1 -1 0  1 -1 0  0 1 0\n";
    const std::string glass = "MA clay DRF 1 1 1\nMA glass TAB 0.5 0.5 0.5\nMA pane TAB 1 0 0\n";
    folder.write("clay.vera", view + glass + "CM clay " + face);
    folder.write(
        "glass.vera", view + glass + "CM clay " + face + "CM glass\n" + face + "CM pane " + face);
    const ProgramRun clay = run_vera(folder, "draw clay.vera -o a.svg");
    ASSERT_EQ(clay.exit_code, 0) << clay.err;
    EXPECT_FALSE(holds(clay.err, "light through")) << clay.err;
    const auto lines_before = std::ranges::count(view, '\n') + std::ranges::count(glass, '\n') + 3;
    const std::string place = "glass.vera:" + std::to_string(lines_before) + ":1: ";
    for (const char* style : {"flat", "shaded", "toon"}) {
        const ProgramRun run =
            run_vera(folder, std::string("draw glass.vera -o b.svg --style ") + style);
        ASSERT_EQ(run.exit_code, 0) << run.err;
        EXPECT_TRUE(holds(
            run.err,
            place
                + "warning: material 'glass' lets light through (as 1 more), and a drawing shows "
                  "nothing through it and no shadow of it"))
            << run.err;
        EXPECT_EQ(run.err.find("light through"), run.err.rfind("light through")) << run.err;
    }
    // Of subscenes, those that are called, also by others, count, and materials that a call hands
    // on.
    const std::string subscenes = "SCENE lit CM clay " + face + "SCENE bare " + face
        + "SCENE window CM glass " + face + "SCENE house CM pane SSC bare SSC window\n";
    const std::string start = view + glass;
    for (const auto& [calls, warns] :
         {std::pair("CM clay SSC lit", false),
          std::pair("CM glass SSC lit", false),
          std::pair("CM glass SSC bare", true),
          std::pair("CM clay SSC house", true)}) {
        folder.write("calls.vera", start + subscenes + "MA last DRF 1 1 1\n" + calls + "\n");
        const ProgramRun run = run_vera(folder, "draw calls.vera -o a.svg");
        ASSERT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(holds(run.err, "light through"), warns) << calls << run.err;
    }
    for (const char* style : {"ids", "lines"}) {
        const ProgramRun run =
            run_vera(folder, std::string("draw glass.vera -o c.svg --style ") + style);
        ASSERT_EQ(run.exit_code, 0) << run.err;
        EXPECT_FALSE(holds(run.err, "light through")) << run.err;
    }
}

TEST(DrawCommand, TellsWhatMakesMaterialsOpaqueInTheFormatOfTheScene) {
    const ScratchFolder folder;
    folder.write("a.mtl", "newmtl glass\nd 0.5\n");
    folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl glass\nf 1 2 3\n");
    folder.write(
        "a.nff",
        "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 64 64\n"
        "f 1 1 1 0.5 0 0 0.5 1\ns 0 0 0 1\n");
    folder.write("a.vera", view + "MA glass TAB 0.5 0.5 0.5\nCM glass P3 -1 -1 0  1 -1 0  0 1 0\n");
    for (const auto& [scene, remedy] :
         {std::pair("a.obj", "'d 1' in the MTL file makes"),
          std::pair("a.nff", "a T of 0 behind 'f' makes"),
          std::pair("a.vera", "TAB 0 0 0 makes")}) {
        const ProgramRun run = run_vera(folder, std::string("draw -o a.svg ") + scene);
        ASSERT_EQ(run.exit_code, 0) << run.err;
        EXPECT_TRUE(holds(run.err, remedy + std::string(" the material opaque"))) << run.err;
    }
}

TEST(DrawCommand, ShowsNamesOfMaterialsWithoutControlCharacters) {
    const ScratchFolder folder;
    folder.write("a.mtl", "newmtl \x1b[31mred\nd 0.5\n");
    folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl \x1b[31mred\nf 1 2 3\n");
    const ProgramRun run = run_vera(folder, "draw a.obj -o a.svg");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(holds(run.err, "material '\\x1b[31mred' lets light through")) << run.err;
}

TEST(DrawCommand, IsRightWhereTrianglesOfOnePlaneArePassedThrough) {
    // Of coincident ones the order goes round; and ways round faces are joined.
    const char* const scenes[] = {
        "PARALLEL 0 0 -1  -2.5 -2.5 4  2.5 -2.5 4  -2.5 2.5 4\n"
        "P3 -0.565 -3 0.5  -0.565 3 0.5  -0.465 3 1.5\n"
        "P3 -3 0.92 1  3 1.92 1  3 1.02 1\n"
        "P3 -0.815 -3 1  0.185 3 1  -0.715 3 1\n"
        "P3 2 0 1  1 2 1  -2 1 1\n"
        "P3 -1.2 0.4 1.1  -1.2 1.2 0.9  -2 1.2 1\n"
        "P3 -1.2 0.4 1.1  -0.4 1.2 1  -1.2 1.2 0.9\n",
        "PROJECTION 0 0 8  -2.5 -2.5 4  2.5 -2.5 4  -2.5 2.5 4\n"
        "P3 3 1 1  -2 0 1  0 -1 1\n"
        "P3 3 1 1.1  0 -1 0.9  -1 1 1\n"
        "P3 1 0 1.1  0 3 0  -2 3 0\n"
        "P3 -1 3 1  0 -3 1  3 1 1\n"};
    const ScratchFolder folder;
    for (const char* scene : scenes)
        for (const char* engine : {"cells", "sweep"}) {
            folder.write("a.vera", scene);
            const ProgramRun run = run_vera(
                folder,
                std::string("draw a.vera --style ids --raster 300x300 --verify=200000 -o a.svg "
                            "--engine ")
                    + engine);
            EXPECT_EQ(run.exit_code, 0) << engine << run.err;
        }
}

} // namespace
} // namespace vera
