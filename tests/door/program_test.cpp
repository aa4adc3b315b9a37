// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <string>

#include "door/program.h"

namespace vera {
namespace {

TEST(Program, TellsItsVersion) {
    const ScratchFolder folder;
    const ProgramRun run = run_vera(folder, "--version");
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_EQ(run.out.substr(0, 5), "vera ");
    EXPECT_EQ(run.err, "");
}

TEST(Program, LoadsNoMoreWhenItsThreadsStart) {
    const ScratchFolder folder;
    folder.write("scene.vera", small_scene);
    const ProgramRun run = run_vera(
        folder, "render scene.vera --raster 32x32 --threads 2 -o a.png -q", "LD_DEBUG=files");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    if (run.err.find("calling init:") == std::string::npos)
        GTEST_SKIP() << "this system's loader does not tell what it loads";
    EXPECT_EQ(run.err.find("file=libtbbmalloc"), std::string::npos);
    EXPECT_EQ(run.err.find("file=libirml"), std::string::npos);
}

TEST(Program, HelpsOnItselfAndEveryCommandWithExamples) {
    const ScratchFolder folder;
    for (const char* arguments :
         {"--help",
          "render --help",
          "draw --help",
          "check --help",
          "info --help",
          "explain --help",
          "ladder --help",
          "make --help",
          "convert --help",
          "solve --help",
          "bench --help",
          "bench curve --help",
          "bench figure --help"}) {
        const ProgramRun run = run_vera(folder, arguments);
        EXPECT_EQ(run.exit_code, 0) << arguments;
        EXPECT_NE(run.out.find("Examples:"), std::string::npos) << arguments;
        EXPECT_EQ(run.err, "") << arguments;
    }
}

TEST(Program, ShowsFirstWhatACommandCannotDoWithout) {
    const ScratchFolder folder;
    for (const auto& [command, rest] : std::map<std::string, std::string>{
             {"render", "SCENE -o PICTURE"},
             {"explain", "SCENE X Y"},
             {"convert", "IN... OUT"},
             {"make surface", "X Y Z -o SCENE"}}) {
        const std::string help = run_vera(folder, command + " --help").out;
        EXPECT_NE(
            help.find("\nUsage: vera " + command + " " + rest + " [OPTIONS]\n"), std::string::npos)
            << help;
    }
}

TEST(Program, SaysWhatIsWrongWithACommandLine) {
    const ScratchFolder folder;

    const struct {
        const char* arguments;
        const char* problem;
    } wrong[] = {
        {"", "vera: error: say what to do: render, draw, "},
        {"rendr a.vera", "vera: error: unknown command 'rendr'; did you mean 'render'?"},
        {"render a.vera -o a.png --rastr 5x5",
         "unknown option '--rastr'; did you mean '--raster'?"},
        {"hello", "unknown command 'hello'; it is one of render, draw, "},
        {"render a.vera -o a.png --width 640",
         "unknown option '--width'; the size is given by --raster, as in --raster 640x480"},
        {"render a.vera -o a.png -W640", "unknown option '-W640'; the size is given by --raster"},
        {"draw a.vera -o a.svg +W640", "unknown argument '+W640'; the size is given by --raster"},
        {"convert a.png b.png --width 640", "unknown option '--width' ("},
        {"-q render", "unknown option '-q' before the command; write it behind: vera render -q"},
        {"render a.vera", "-o PICTURE is missing; write vera render SCENE -o PICTURE"},
        {"render", "SCENE is missing; write vera render SCENE -o PICTURE"},
        {"info", "SCENE is missing; write vera info SCENE"},
        {"convert", "IN... OUT is missing; write vera convert IN... OUT"},
        {"solve a.exr", "-o CONTROL is missing; write vera solve LAYERS -o CONTROL"},
        {"render a.vera -o a.png extra",
         "unknown argument 'extra'; write vera render SCENE -o PICTURE"},
        {"render a.vera -o a.png -q=no", "unknown option '-=no'"},
        {"render a.vera -o a.png -o b.png",
         "--output is given 2 times, with 'a.png' and 'b.png'; give it once"},
        {"render a.vera -o",
         "--output PICTURE (picture to write; - for standard output) takes a value; found none"},
        {"render a.vera -o=a.png", "'=' is for long names; write -o a.png or --output=a.png"},
        {"render a.vera -o ''", "takes a value; found '', which is empty"},
        {"render a.vera -o a.png --depth ''", "takes a value; found '', which is empty"},
        {"render a.vera -o a.png --json=5", "--json takes no value; leave out what stands behind"},
        {"render a.vera -o a.png --index", "--index takes auto, bvh, grid or brute; found none"},
        {"render a.vera -o a.png --index gird",
         "--index takes auto, bvh, grid or brute; found 'gird'; did you mean 'grid'?"},
        {"render a.vera -o a.png --index bvh --index grid",
         "--index is given 2 times, with 'bvh' and 'grid'; give it once"},
        {"render a.vera -o a.png --sky 1 2",
         "--sky R G B (colour of the sky overhead) takes 3 values; found 2: '1' and '2'"},
        {"render a.vera -o a.png --sky 1 2 blue", "takes 3 numbers; found 'blue'"},
        {"convert a.png b.png --colors x",
         "--colors N (the best so many, 2 to 256; 256 for GIF) takes a number; found 'x'"},
        {"convert a.png b.png --palette",
         "text file of #rrggbb, one a line) takes a value; found none"},
        {"draw a.vera -o a.svg --verify=x", "takes a number; found 'x'"},
        {"solve a.exr -o a.ctl --lights", "takes values; found none"},
        {"solve a.exr -o a.ctl --lights red", "takes numbers; found 'red'"},
    };

    for (const auto& [arguments, problem] : wrong) {
        const ProgramRun run = run_vera(folder, arguments);
        EXPECT_EQ(run.exit_code, 2) << arguments;
        EXPECT_EQ(run.out, "") << arguments;
        EXPECT_NE(run.err.find(problem), std::string::npos) << arguments << '\n' << run.err;
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    }
}

TEST(Program, StopsAtOnceWhenInterruptedWhileItReads) {
    const ScratchFolder folder;
    for (const char* arguments : {"check -", "info -", "render - -o a.png", "check pipe"}) {
        const ProgramRun run = run_vera(
            folder,
            std::string(arguments)
                + " <pipe & child=$!; sleep 2 >pipe & sleep 0.5; kill -INT $child; wait $child",
            "rm -f pipe; mkfifo pipe;");
        EXPECT_EQ(run.exit_code, 130) << arguments;
        EXPECT_EQ(run.err, "vera: interrupted\n") << arguments;
        EXPECT_EQ(folder.file_count(), 1U) << arguments;
    }
}

} // namespace
} // namespace vera
