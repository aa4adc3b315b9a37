// SPDX-License-Identifier: Apache-2.0
// How `vera draw` ends before it has drawn: at a limit of time or memory, or interrupted.
#include <filesystem>
#include <string>

#include "base/memory_is_watched.h"
#include "door/program.h"
#include "door/svg_text.h"
#include <sys/stat.h>

namespace vera {
namespace {

/// So many facets that to draw them takes long, and memory.
std::string many_spheres() {
    std::string text = view;
    for (int i = 0; i < 400; ++i)
        text += "SP 0 " + std::to_string(1 + 0.001 * i) + " 0 1\n";
    return text;
}

TEST(DrawCommand, GivesUpAfterTheTimeLimitAndLeavesNoFile) {
    const ScratchFolder folder;
    folder.write("a.vera", many_spheres());
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

TEST(DrawCommand, RefusesWhatWouldTakeMoreThanTheMemoryLimit) {
    const ScratchFolder folder;
    folder.write("a.vera", many_spheres());
    const ProgramRun run = run_vera(folder, "draw a.vera --memory-limit 40M -o a.svg");
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_TRUE(holds(run.err, "vera: error: the scene in ")) << run.err;
    EXPECT_TRUE(holds(run.err, " facets takes about ")) << run.err;
    EXPECT_TRUE(holds(run.err, "MiB are available: a larger --deviation makes fewer")) << run.err;
    EXPECT_EQ(folder.file_count(), 1U);

    folder.write("b.vera", small_scene);
    const ProgramRun little = run_vera(folder, "draw b.vera --memory-limit 1 -o b.svg");
    EXPECT_EQ(little.exit_code, 3) << little.err;
    EXPECT_TRUE(holds(little.err, "vera: error: the program and the scene take about "))
        << little.err;
    EXPECT_TRUE(holds(little.err, "M at least")) << little.err;
    EXPECT_EQ(folder.file_count(), 2U);
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

} // namespace
} // namespace vera
