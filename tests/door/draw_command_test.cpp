// SPDX-License-Identifier: Apache-2.0
// How `vera draw` is asked and answers; that it gives the same file always.
#include <filesystem>
#include <string>
#include <string_view>

#include "door/program.h"
#include "door/svg_text.h"

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

TEST(DrawCommand, GoesOnWhereNobodyHearsItsMessages) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    ASSERT_EQ(run_vera(folder, "draw a.vera -o a.svg").exit_code, 0);
    for (const std::string stream : {"2>&-", "2>/dev/full", ">&- 2>&-"}) {
        if (stream == "2>/dev/full" && !std::filesystem::exists("/dev/full"))
            continue;
        EXPECT_EQ(run_vera(folder, "draw a.vera -o b.svg --progress json " + stream).exit_code, 0);
        EXPECT_EQ(folder.read("b.svg"), folder.read("a.svg")) << stream;
        // The report of a drawing on standard output is a message too.
        if (!stream.starts_with(">&-")) {
            const std::string piped = "draw a.vera --format svg -o - --json >c.svg " + stream;
            EXPECT_EQ(run_vera(folder, piped).exit_code, 0) << stream;
            EXPECT_EQ(folder.read("c.svg"), folder.read("a.svg")) << stream;
        }
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

TEST(DrawCommand, WritesToWhatIsNoFileAsWell) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    const ProgramRun run = run_vera(folder, "draw a.vera -o /dev/null --format svg --json");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("\"bytes\": 0"), std::string::npos) << run.out;
}

} // namespace
} // namespace vera
