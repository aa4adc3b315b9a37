// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "base/memory_is_watched.h"
#include "door/program.h"
#include "door/svg_text.h"
#include <sys/stat.h>

namespace vera {
namespace {

TEST(DrawCommand, WritesEveryFormatByExtensionAndByName) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);

    const struct {
        const char* output;
        const char* begin;
        const char* end;
    } files[] = {
        {"a.svg", "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg ", "</svg>\n"},
        {"a.pdf", "%PDF-1.7\n", "%%EOF\n"},
        {"a.EPS", "%!PS-Adobe-3.0 EPSF-3.0\n", "%%EOF\n"},
        {"a.picture --format svg", "<?xml ", "</svg>\n"},
        {"a.dxf --style lines", "999\na\n", "0\nEOF\n"},
    };

    for (const auto& [output, begin, end] : files) {
        const ProgramRun run =
            run_vera(folder, std::string("draw a.vera --raster 40x30 -o ") + output);
        ASSERT_EQ(run.exit_code, 0) << output << '\n' << run.err;
        EXPECT_EQ(run.out, "") << output;
        const std::string words = output;
        const std::string bytes = folder.read(words.substr(0, words.find(' ')));
        EXPECT_TRUE(bytes.starts_with(begin)) << output;
        EXPECT_TRUE(bytes.ends_with(end)) << output;
    }
    const std::string svg = folder.read("a.svg");
    EXPECT_TRUE(holds(svg, "width=\"40\" height=\"30\" viewBox=\"0 0 40 30\"")) << svg;
    EXPECT_TRUE(holds(svg, "<title>a</title>")) << svg;
    EXPECT_EQ(folder.file_count(), 6U);
}

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

TEST(DrawCommand, WritesToStandardOutputAndReadsStandardInput) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    const ProgramRun run = run_vera(folder, "draw a.vera --raster 9x9 --format eps -o -");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(run.out.starts_with("%!PS-Adobe-3.0 EPSF-3.0\n"));
    EXPECT_TRUE(run.err.starts_with("standard output: ")) << run.err;
    const ProgramRun counted = run_vera(folder, "draw a.vera --format svg --json -o -");
    EXPECT_TRUE(counted.out.ends_with("</svg>\n"));
    EXPECT_TRUE(holds(counted.err, "\"visible_faces\"")) << counted.err;
    const ProgramRun piped = run_vera(folder, "draw - -q --raster 9x9 -o b.pdf < a.vera");
    EXPECT_EQ(piped.exit_code, 0) << piped.err;
    EXPECT_EQ(piped.err, "");
    EXPECT_TRUE(folder.read("b.pdf").starts_with("%PDF-1.7\n"));
}

TEST(DrawCommand, GivesTheSameFileInEveryRunForAnyNumberOfThreads) {
    const ScratchFolder folder;
    // They pass through each other, so that cutting is among the work that is shared out.
    folder.write("a.vera", view + "SP -0.5 1.7 0 1\nSP 0.5 2.1 0.3 1\nSP 0 1 0.4 0.9\n");
    for (const std::string_view style : {"flat", "shaded", "ids", "lines", "hidden-lines", "toon"})
        for (const std::string_view format : {"svg", "pdf", "eps", "dxf"}) {
            if (format == "dxf" && !style.ends_with("lines"))
                continue;
            const std::string command = "draw a.vera --deviation 1 --style " + std::string(style)
                + " --format " + std::string(format);
            ASSERT_EQ(run_vera(folder, command + " --threads 1 -o 1").exit_code, 0) << command;
            const std::string expected = folder.read("1");
            for (const char* threads : {"1", "2", "7"}) {
                ASSERT_EQ(run_vera(folder, command + " -o 2 --threads " + threads).exit_code, 0);
                EXPECT_EQ(folder.read("2") == expected, true) << command << ' ' << threads;
            }
        }
}

TEST(DrawCommand, GivesTheSameFileByEitherEngine) {
    const ScratchFolder folder;
    // Things that touch, cover and pass through each other.
    folder.write(
        "a.vera",
        view
            + "P4 -9 0 9  9 0 9  9 0 -9  -9 0 -9\n"
              "SP 0 1 -4 1\n"
              "SP 0.7 1.2 -4 0.8\n"
              "P3 -2 0 -5  2 0.5 -3  0 3 -4\n");
    for (const std::string style : {"flat", "ids"}) {
        const std::string draw = "draw a.vera --deviation 1 --style " + style;
        ASSERT_EQ(run_vera(folder, draw + " -o cells.svg").exit_code, 0);
        const ProgramRun run = run_vera(folder, draw + " --engine sweep -o sweep.svg --json");
        ASSERT_EQ(run.exit_code, 0) << run.err;
        EXPECT_FALSE(holds(run.out, "\"cut_rounds\": 0")) << run.out;
        EXPECT_EQ(folder.read("cells.svg"), folder.read("sweep.svg")) << style;
    }
}

TEST(DrawCommand, RefusesWhatItCannotUnderstand) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);

    const struct {
        const char* arguments;
        const char* problem;
    } wrong[] = {
        {"", "-o DRAWING is missing; write vera draw SCENE -o DRAWING"},
        {"-o -", "a drawing on standard output needs --format, as in --format svg"},
        {"-o a.xyz",
         "cannot tell the format of 'a.xyz' by its name; give --format with one of svg, pdf, eps, "
         "dxf"},
        {"-o a.png",
         "cannot tell the format of 'a.png' by its name; give --format with one of svg, pdf, eps, "
         "dxf, "
         "or make a picture with 'vera render'"},
        {"-o a.vsg",
         "cannot tell the format of 'a.vsg' by its name; did you mean 'a.svg'? Else give --format "
         "with one of svg, pdf, eps, dxf"},
        {"-o a.svg --format png", "--format does not know 'png'; it knows svg, pdf, eps, dxf"},
        {"-o a.dxf --style toon",
         "DXF is for lines, and --style toon fills areas; take --style lines or hidden-lines, or "
         "another format"},
        {"-o a.svg --line crease:width=2",
         "--line is for styles with lines, and --style flat has none; take --style lines, "
         "hidden-lines or toon"},
        {"-o a.svg --style lines --line hiden:width=2",
         "--line knows no class of lines 'hiden'; did you mean 'hidden'? Else it knows hidden, "
         "shadow, intersection, crease, silhouette"},
        {"-o a.svg --style lines --line hidden",
         "--line takes a class and what is to hold for it, as in "
         "silhouette:width=2,color=#333,dash=4-2; found 'hidden'"},
        {"-o a.svg --style lines --line hidden:colour=#000",
         "--line knows no property of lines 'colour'; did you mean 'color'? Else it knows width, "
         "color, dash"},
        {"-o a.svg --style lines --line hidden:width=0",
         "--line takes a width from 0.01 to 1000 pixels; found '0'"},
        {"-o a.svg --style lines --line hidden:color=#1234",
         "--line takes a color as #rgb or #rrggbb, such as #c00; found '#1234'"},
        {"-o a.svg --style lines --line hidden:dash=4--2",
         "--line takes dashes and gaps from 0.01 to 1000 pixels, as in dash=4-2, or dash=none; "
         "found '4--2'"},
        {"-o a.svg --style lnes",
         "--style takes flat, shaded, ids, lines, hidden-lines or toon; found 'lnes'; did you mean "
         "'lines'?"},
        {"-o a.svg --style hatched",
         "--style takes flat, shaded, ids, lines, hidden-lines or toon; found 'hatched'"},
        {"-o a.svg --engine swep",
         "--engine takes cells or sweep; found 'swep'; did you mean 'sweep'?"},
        {"-o a.svg --precision 0", "--precision takes a number from 1e-06 to 1; found 0"},
        {"-o a.svg --precision 2", "--precision takes a number from 1e-06 to 1; found 2"},
        {"-o a.svg --precision nan", "--precision takes a number from 1e-06 to 1; found nan"},
        {"-o a.svg --deviation 0", "--deviation takes a number from 0.0001 to 100; found 0"},
        {"-o a.svg --deviation 101", "--deviation takes a number from 0.0001 to 100; found 101"},
        {"-o a.svg --color-tolerance 2",
         "--color-tolerance is for gradients, and --style flat has none; take --style shaded"},
        {"-o a.vera --format svg", "--output would write over 'a.vera', which is read"},
        {"-o a.svg --color-tolerance 0.5",
         "--color-tolerance takes a number from 0.6 to 255; found 0.5"},
        {"-o a.svg --page -1", "--page takes a number from 0 to 100000; found -1"},
        {"-o a.svg --threads 1.5", "--threads takes a whole number from 0 to 1024; found 1.5"},
        {"-o a.svg --threads 1025", "--threads takes a whole number from 0 to 1024; found 1025"},
        {"-o a.svg --raster 40", "--raster takes WIDTHxHEIGHT in pixels"},
        {"-o a.svg --index bvh", "unknown option '--index'"},
    };

    for (const auto& [arguments, problem] : wrong) {
        const ProgramRun run = run_vera(folder, std::string("draw a.vera ") + arguments);
        EXPECT_EQ(run.exit_code, 2) << arguments << run.err;
        EXPECT_TRUE(run.err.starts_with(std::string("vera: error: ") + problem))
            << arguments << '\n'
            << run.err;
        EXPECT_TRUE(run.err.ends_with("('vera draw --help' tells more)\n")) << run.err;
    }
    EXPECT_EQ(folder.file_count(), 1U);
}

TEST(DrawCommand, WritesOverNoMeshAndNoMaterialsThatItReads) {
    const ScratchFolder folder;
    folder.write("a.vera", "MESH \"a.obj\"");
    folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
    folder.write("a.mtl", "newmtl red\nKd 1 0 0\n");
    for (const char* scene : {"a.vera", "a.obj"})
        for (const std::string output : {"a.obj", "a.mtl"}) {
            const ProgramRun run =
                run_vera(folder, "draw " + std::string(scene) + " -o " + output + " --format svg");
            EXPECT_EQ(run.exit_code, 2) << run.err;
            EXPECT_TRUE(holds(run.err, "would write over '" + output + "', which")) << run.err;
        }
    EXPECT_TRUE(folder.read("a.mtl").starts_with("newmtl"));
}

TEST(DrawCommand, TellsAWrongSceneWithItsPlaceAndWritesNothing) {
    const ScratchFolder folder;
    folder.write("a.vera", "PROJECTION 0 2 8  -2 0 0  2 0 0  -2 4 0\nSP 0 1 blue 1\n");
    const ProgramRun run = run_vera(folder, "draw a.vera -o a.svg");
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_TRUE(holds(run.err, "a.vera:2:8: error: ")) << run.err;
    EXPECT_EQ(folder.file_count(), 1U);
}

TEST(DrawCommand, FailsClearlyWhereItCannotReadOrWrite) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    const ProgramRun missing = run_vera(folder, "draw b.vera -o a.svg");
    EXPECT_EQ(missing.exit_code, 3);
    EXPECT_EQ(
        missing.err,
        "vera: error: cannot read 'b.vera' (did you mean 'a.vera'?): No such file or directory\n");
    const ProgramRun unwritable = run_vera(folder, "draw a.vera -o no/such/a.svg");
    EXPECT_EQ(unwritable.exit_code, 3);
    EXPECT_EQ(
        unwritable.err,
        "vera: error: cannot write 'no/such/a.svg'; make its folder first: No such file or "
        "directory\n");
    if (std::filesystem::exists("/dev/full")) {
        EXPECT_EQ(run_vera(folder, "draw a.vera --format svg -o - >/dev/full").exit_code, 3);
    }
    EXPECT_EQ(folder.file_count(), 1U);
}

TEST(DrawCommand, GoesOnWhereNobodyHearsItsMessages) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    ASSERT_EQ(run_vera(folder, "draw a.vera -o a.svg").exit_code, 0);
    for (const std::string stream : {"2>&-", "2>/dev/full", ">&- 2>&-"}) {
        if (stream == "2>/dev/full" && !std::filesystem::exists("/dev/full"))
            continue;
        EXPECT_EQ(run_vera(folder, "draw a.vera -o b.svg --progress json " + stream).exit_code, 0);
        EXPECT_EQ(folder.read("b.svg"), folder.read("a.svg")) << stream;
        EXPECT_EQ(run_vera(folder, "draw b.vera -o a.svg " + stream).exit_code, 3) << stream;
        EXPECT_EQ(run_vera(folder, "draw a.vera " + stream).exit_code, 2) << stream;
    }
}

TEST(DrawCommand, ReportsCountsAndProgressAsJson) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    const ProgramRun run =
        run_vera(folder, "draw a.vera --style ids -o a.svg --progress json --json");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(run.out.starts_with("{\n  \"version\": 1,\n  \"facets\": ")) << run.out;
    for (const char* part :
         {"\"visible_faces\": 2,",
          "\"cut_rounds\": 0,",
          "\"penetrating\": 0,",
          "\"bytes\": ",
          "\"read\": ",
          "\"draw\": ",
          "\"write\": "})
        EXPECT_TRUE(holds(run.out, part)) << part << '\n' << run.out;
    EXPECT_TRUE(holds(run.out, "\"bytes\": " + std::to_string(folder.read("a.svg").size()) + ","))
        << run.out;
    EXPECT_TRUE(holds(run.err, "{\"version\": 1, \"stage\": \"draw\", \"done\": 1.0000"))
        << run.err;
}

TEST(DrawCommand, ShowsExamplesInItsHelp) {
    const ScratchFolder folder;
    const ProgramRun run = run_vera(folder, "draw --help");
    EXPECT_EQ(run.exit_code, 0);
    for (const char* example :
         {"Examples:\n  vera draw bracket.obj -o bracket.svg\n",
          "  vera draw scene.vera -o scene.pdf --page 120\n",
          "  vera draw scene.vera -o outlines.svg --style lines --line silhouette:width=3\n",
          "  vera draw scene.vera -o plan.dxf --style hidden-lines --page 200"})
        EXPECT_TRUE(holds(run.out, example)) << run.out;
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

TEST(DrawCommand, ComparesTheDrawingWithRaysOnDemand) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    const ProgramRun run = run_vera(folder, "draw a.vera --verify=3000 -o a.svg");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(holds(run.err, "verified: at ")) << run.err;
    EXPECT_TRUE(holds(run.err, "3000 points the drawing shows what a ray sees")) << run.err;
    const ProgramRun json = run_vera(folder, "draw a.vera --verify --json -o b.svg");
    EXPECT_EQ(json.exit_code, 0) << json.err;
    EXPECT_TRUE(holds(json.out, "\"points\": 100000,")) << json.out;
    EXPECT_EQ(folder.read("a.svg"), folder.read("b.svg"));
    const ProgramRun wrong = run_vera(folder, "draw a.vera --verify=-1 -o c.svg");
    EXPECT_EQ(wrong.exit_code, 2) << wrong.err;
    EXPECT_TRUE(holds(wrong.err, "--verify takes a whole number from 0 to")) << wrong.err;
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

TEST(DrawCommand, GivesUpAfterTheTimeLimitAndLeavesNoFile) {
    const ScratchFolder folder;
    std::string text = view;
    for (int i = 0; i < 400; ++i)
        text += "SP 0 " + std::to_string(1 + 0.001 * i) + " 0 1\n";
    folder.write("a.vera", text);
    const ProgramRun run = run_vera(folder, "draw a.vera --time-limit 0.01 -o a.svg");
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_TRUE(holds(run.err, "the drawing takes longer than --time-limit 0.01 allows"))
        << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "a.svg"));
    const ProgramRun wrong = run_vera(folder, "draw a.vera --time-limit -1 -o a.svg");
    EXPECT_EQ(wrong.exit_code, 2) << wrong.err;
}

TEST(DrawCommand, GivesUpAfterTheTimeLimitWhileItReadsAsWell) {
    const ScratchFolder folder;
    // A scene that never comes: nobody writes into the pipe, and nobody closes it.
    ASSERT_EQ(mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
    const ProgramRun run = run_vera(folder, "draw - --time-limit 0.1 -o a.svg <>pipe");
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_TRUE(holds(run.err, "the drawing takes longer than --time-limit 0.1 allows")) << run.err;
    EXPECT_EQ(folder.file_count(), 1U);
}

/// Enough facets for more memory than anybody would not have.
std::string many_spheres() {
    std::string text = view;
    for (int i = 0; i < 400; ++i)
        text += "SP 0 " + std::to_string(1 + 0.001 * i) + " 0 1\n";
    return text;
}

TEST(DrawCommand, RefusesWhatWouldTakeMoreThanTheMemoryLimit) {
    const ScratchFolder folder;
    folder.write("a.vera", many_spheres());
    const ProgramRun run = run_vera(folder, "draw a.vera --memory-limit 20M -o a.svg");
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_TRUE(holds(run.err, "vera: error: the scene in ")) << run.err;
    EXPECT_TRUE(holds(run.err, " facets takes about ")) << run.err;
    EXPECT_TRUE(holds(run.err, "MiB are available: a larger --deviation makes fewer")) << run.err;
    EXPECT_EQ(folder.file_count(), 1U);

    folder.write("b.vera", small_scene);
    const ProgramRun enough = run_vera(folder, "draw b.vera --memory-limit 1.5g -o b.svg");
    EXPECT_EQ(enough.exit_code, 0) << enough.err;
    for (const char* wrong : {"much", "-1M", "M", "1e40", "3X"}) {
        const ProgramRun refused =
            run_vera(folder, std::string("draw b.vera -o c.svg --memory-limit=") + wrong);
        EXPECT_EQ(refused.exit_code, 2) << wrong << refused.err;
        EXPECT_TRUE(holds(refused.err, "--memory-limit takes a size as in 500M or 2.5G; found '"))
            << refused.err;
    }
}

TEST(DrawCommand, EndsWithoutAFileWhereTheSystemGivesNoMoreMemory) {
    if (memory_is_watched())
        GTEST_SKIP() << "a sanitizer takes memory of its own";
    const ScratchFolder folder;
    folder.write("a.vera", many_spheres());
    for (const int mebibytes : {60, 90, 120, 200}) {
        const ProgramRun run = run_vera(
            folder,
            "draw a.vera --threads 1 -o a.svg",
            "ulimit -v " + std::to_string(1024 * mebibytes) + ";");
        EXPECT_EQ(run.exit_code, 3) << mebibytes << '\n' << run.err;
        EXPECT_TRUE(holds(run.err, "memory")) << run.err;
        EXPECT_EQ(folder.file_count(), 1U);
    }
}

TEST(DrawCommand, LeavesNoFileWhenInterrupted) {
    const ScratchFolder folder;
    std::string text = view;
    for (int i = 0; i < 8; ++i)
        text += "SP 0 2 0 1." + std::to_string(10 + i) + "\n";
    folder.write("a.vera", text);
    const ProgramRun run = run_vera(
        folder,
        "draw a.vera --deviation 0.0001 -o a.svg & child=$!; sleep 0.3; kill -INT $child; wait "
        "$child");
    EXPECT_EQ(run.exit_code, 130) << run.err;
    EXPECT_EQ(folder.file_count(), 1U);
}

TEST(DrawCommand, WritesToWhatIsNoFileAsWell) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    const ProgramRun run = run_vera(folder, "draw a.vera -o /dev/null --format svg --json");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("\"bytes\": 0"), std::string::npos) << run.out;
}

} // namespace
} // namespace vera
