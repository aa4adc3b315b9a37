// SPDX-License-Identifier: Apache-2.0
// What `vera draw` refuses, and how it says so.
#include <filesystem>
#include <string>

#include "door/program.h"
#include "door/svg_text.h"

namespace vera {
namespace {

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
    const ProgramRun too_large = run_vera(folder, "draw a.vera -o a.svg", "ulimit -f 1;");
    EXPECT_EQ(too_large.exit_code, 3);
    EXPECT_EQ(
        too_large.err,
        "vera: error: cannot write 'a.svg'; raise the limit on the size of files (ulimit -f) or "
        "choose a smaller picture: File too large\n");
    EXPECT_EQ(folder.file_count(), 1U);
}

} // namespace
} // namespace vera
