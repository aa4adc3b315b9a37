// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

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
        {"render a.vera", "--output is required"},
        {"render", "scene is required"},
        {"render a.vera -o a.png extra", "unknown argument 'extra'"},
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
