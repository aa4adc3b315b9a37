// SPDX-License-Identifier: Apache-2.0
#include "vera/image/image_file.h"

#include "door/program.h"

namespace vera {
namespace {

TEST(RenderCommand, WritesEveryFormatBySuffixAndByName) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    for (const char* name : {"a.png", "a.exr", "a.jpg", "a.ppm", "a.pfm", "a.vra"}) {
        const ProgramRun run =
            run_vera(folder, std::string("render a.vera --raster 40x30 -o ") + name);
        ASSERT_EQ(run.exit_code, 0) << name << '\n' << run.err;
        const Image image = read_image(folder.path() / name);
        EXPECT_EQ(image.width, 40U) << name;
        EXPECT_EQ(image.height, 30U) << name;
    }
    ASSERT_EQ(
        run_vera(folder, "render a.vera --raster 4x3 --format png16 -o odd.picture").exit_code, 0);
    EXPECT_EQ(folder.read("odd.picture").substr(1, 3), "PNG");
}

TEST(RenderCommand, WritesToStandardOutputAndReadsStandardInput) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    const ProgramRun run = run_vera(folder, "render a.vera --raster 4x3 --format ppm -o -");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out.substr(0, 2), "P6");
    EXPECT_EQ(run.err.rfind("standard output: ", 0), 0U) << run.err;
    const ProgramRun piped =
        run_vera(folder, "render - -q --raster 4x3 --format ppm -o b.ppm < a.vera");
    EXPECT_EQ(piped.exit_code, 0) << piped.err;
    EXPECT_EQ(folder.read("b.ppm").substr(0, 2), "P6");
}

TEST(RenderCommand, GivesTheSameFileForAnyNumberOfThreadsAndEitherIndex) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    ASSERT_EQ(run_vera(folder, "render a.vera --raster 90x70 -o 1.png --threads 1").exit_code, 0);
    const std::string expected = folder.read("1.png");
    for (const char* options : {"--threads 2", "--threads 7", "--index brute", "--index grid"}) {
        ASSERT_EQ(
            run_vera(folder, std::string("render a.vera --raster 90x70 -o 2.png ") + options)
                .exit_code,
            0);
        EXPECT_EQ(folder.read("2.png"), expected) << options;
    }
}

TEST(RenderCommand, LetsOptionsOverrideTheControlFile) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    folder.write("a.ctl", "RASTER 8 6 SHADOWS");
    ASSERT_EQ(run_vera(folder, "render a.vera -c a.ctl -o a.png").exit_code, 0);
    EXPECT_EQ(read_image(folder.path() / "a.png").width, 8U);
    ASSERT_EQ(run_vera(folder, "render a.vera -c a.ctl --raster 10x6 -o a.png").exit_code, 0);
    EXPECT_EQ(read_image(folder.path() / "a.png").width, 10U);
}

TEST(RenderCommand, RefusesWhatItCannotUnderstand) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);

    const struct {
        const char* arguments;
        const char* problem;
    } wrong[] = {
        {"-o a.png --raster 40", "--raster takes WIDTHxHEIGHT"},
        {"-o a.png --raster 0x4", "--raster takes WIDTHxHEIGHT"},
        {"-o a.png --antialias maybe", "--antialias takes on or off; found 'maybe'"},
        {"-o a.png --depth 0", "--depth takes a whole number from 1"},
        {"-o a.png --samples 3", "--samples takes a power of two from 2 to 256; found 3"},
        {"-o a.png --threads -2",
         "vera: error: --threads takes a whole number from 0 to 1024; found -2 ("},
        {"-o a.png --threads 1.5", "--threads takes a whole number from 0 to 1024; found 1.5"},
        {"-o a.png --threads 4294967296",
         "--threads takes a whole number from 0 to 1024; found 4294967296"},
        {"-o a.png --samples 8 --antialias off", "--samples is for smoothed edges"},
        {"-o a.vera --format png", "--output would write over 'a.vera', which is read; name"},
        {"-o ./a.exr --layers a.exr", "'a.exr' cannot hold both the picture and its layers"},
        {"-o a.png --ambient 0 nan 0", "--ambient takes three finite numbers; found nan"},
        {"-o a.png --quality 95", "--quality is for JPEG; write a .jpg, or leave it out"},
        {"-o a.jpg --quality 0", "--quality takes a number from 1 to 100; found 0"},
        {"-o a.png --exposure 2", "--exposure takes a number from 0 to 1; found 2"},
        {"-o a.png --earth 1 1 1", "--horizon and --earth need a sky"},
        {"-o a.png --index gird",
         "vera: error: --index takes auto, bvh, grid or brute; found 'gird'; did you mean 'grid'?"},
        {"-o a.png --scene-format tree",
         "vera: error: --scene-format takes vera, nff, obj, ply or stl; found 'tree' ("},
        {"-o a.png --color no", "--color takes auto, always or never; found 'no' ("},
        {"-o a.xyz", "cannot tell the format of 'a.xyz' by its name; give --format with one of"},
        {"-o a.svg", "vra, vra16, or make a drawing with 'vera draw'"},
        {"-o a.pgn", "cannot tell the format of 'a.pgn' by its name; did you mean 'a.png'?"},
        {"-o -", "--format"},
    };

    for (const auto& [arguments, problem] : wrong) {
        const ProgramRun run = run_vera(folder, std::string("render a.vera ") + arguments);
        EXPECT_EQ(run.exit_code, 2) << arguments << run.err;
        EXPECT_NE(run.err.find(problem), std::string::npos) << arguments << '\n' << run.err;
    }
    EXPECT_EQ(folder.file_count(), 1U);
}

TEST(RenderCommand, TellsAWrongSceneWithItsPlaceAndWritesNothing) {
    const ScratchFolder folder;
    folder.write(
        "a.vera", "PROJECTION 0 2 8  -2 0 0  2 0 0  -2 4 0\nSP 0 1 blue 1\nLI 1 2 3 four 1 1 1\n");
    const ProgramRun run = run_vera(folder, "render a.vera -o a.png");
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.err.find("a.vera:2:8: error: "), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("a.vera:3:10: error: "), std::string::npos) << run.err;
    EXPECT_EQ(folder.file_count(), 1U);
}

TEST(RenderCommand, FailsClearlyWhereItCannotReadOrWrite) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    const ProgramRun missing = run_vera(folder, "render b.vera -o a.png");
    EXPECT_EQ(missing.exit_code, 3);
    EXPECT_NE(missing.err.find("b.vera"), std::string::npos);
    EXPECT_EQ(
        missing.err,
        "vera: error: cannot read 'b.vera' (did you mean 'a.vera'?): No such file or directory\n");
    const ProgramRun unwritable =
        run_vera(folder, "render a.vera --raster 4x4 -o no/such/folder/a.png");
    EXPECT_EQ(unwritable.exit_code, 3);
    EXPECT_NE(unwritable.err.find("no/such/folder"), std::string::npos);
    if (std::filesystem::exists("/dev/full")) {
        const ProgramRun full =
            run_vera(folder, "render a.vera --raster 64x64 --format ppm -o - >/dev/full");
        EXPECT_EQ(full.exit_code, 3) << full.err;
        for (const char* arguments :
             {"check a.vera", "info a.vera", "info a.vera --json", "--help"}) {
            const ProgramRun run = run_vera(folder, std::string(arguments) + " >/dev/full");
            EXPECT_EQ(run.exit_code, 3) << arguments;
            EXPECT_EQ(
                run.err, "vera: error: cannot write standard output: No space left on device\n");
        }
    }
}

TEST(RenderCommand, SaysThatAFileMayNotGrowAndLeavesNone) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    const ProgramRun run =
        run_vera(folder, "render a.vera --raster 64x64 -o a.ppm", "ulimit -f 8;");
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_EQ(
        run.err,
        "vera: error: cannot write 'a.ppm'; raise the limit on the size of files (ulimit -f) or "
        "choose a smaller picture: File too large\n");
    EXPECT_EQ(folder.file_count(), 1U);
}

TEST(RenderCommand, FramesAndLightsAMeshThatComesAlone) {
    const ScratchFolder folder;
    folder.write(
        "t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
    const ProgramRun run = run_vera(folder, "render t.obj --raster 64x64 --format ppm -o t.ppm");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const std::string bytes = folder.read("t.ppm");
    unsigned char brightest = 0;
    for (std::size_t i = bytes.size() - 3 * 64 * 64; i < bytes.size(); ++i)
        brightest = std::max(brightest, static_cast<unsigned char>(bytes[i]));
    EXPECT_GT(brightest, 100);
}

TEST(RenderCommand, ReportsProgressAndStatisticsAsJson) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    const ProgramRun run =
        run_vera(folder, "render a.vera --raster 64x64 -o a.png --progress json --json");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(
        run.err.find("{\"version\": 1, \"stage\": \"render\", \"done\": 1.0000"), std::string::npos)
        << run.err;
    EXPECT_NE(run.out.find("\"view_rays\""), std::string::npos) << run.out;
}

TEST(RenderCommand, CountsTheRaysOfAntialiasingAmongTheViewRaysInItsSummary) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    const ProgramRun run = run_vera(folder, "render a.vera --raster 64x64 -o a.png");
    unsigned view_rays = 0;
    unsigned for_antialiasing = 0;
    ASSERT_EQ(
        std::sscanf(
            run.err.c_str(),
            "a.png: %u view rays (%u of them for antialiasing), ",
            &view_rays,
            &for_antialiasing),
        2)
        << run.err;
    EXPECT_EQ(view_rays - for_antialiasing, 64U * 64U);
}

TEST(RenderCommand, LeavesNoFileWhenInterrupted) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    const ProgramRun run = run_vera(
        folder,
        "render a.vera --raster 8000x8000 -o a.png & child=$!; sleep 0.3; kill -INT $child; wait "
        "$child");
    EXPECT_EQ(run.exit_code, 130) << run.err;
    EXPECT_EQ(folder.file_count(), 1U);
}

} // namespace
} // namespace vera
