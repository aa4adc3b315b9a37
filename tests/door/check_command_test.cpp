// SPDX-License-Identifier: Apache-2.0
#include "door/program.h"

namespace vera {
namespace {

TEST(CheckCommand, IsContentWithAGoodScene) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    const ProgramRun run = run_vera(folder, "check a.vera");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out, "a.vera: good\n");
}

TEST(CheckCommand, WarnsOfASceneThatWouldBeBlack) {
    const ScratchFolder folder;
    folder.write(
        "a.vera", "PROJECTION 0 2 8  -2 0 0  2 0 0  -2 4 0\nCM a SP 0 0 0 1 MA a DRF 1 1 1\n");
    const ProgramRun run = run_vera(folder, "check a.vera");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.err.find("warning: "), std::string::npos) << run.err;
    EXPECT_EQ(run.out, "a.vera: good, with 1 warning\n");
}

TEST(CheckCommand, WarnsOfASceneTextWithoutCameraUnlessFramingIsAskedFor) {
    const ScratchFolder folder;
    folder.write("a.vera", "LI 3 6 5  40 1 1 1  CM a  SP 0 0 0 1  MA a DRF 1 1 1\n");
    const ProgramRun run = run_vera(folder, "check a.vera");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(
        run.err,
        "a.vera: warning: there is no PROJECTION or PARALLEL: the whole scene is framed\n"
        "  add one, or say that this is meant: FRAME in the control file, or --frame\n");
    EXPECT_EQ(run_vera(folder, "check a.vera --frame 0.1").err, "");
}

TEST(CheckCommand, ShowsWhatTheViewPointLiesInAndEachUnusedMaterialOnce) {
    const ScratchFolder folder;
    folder.write("a.vera", std::string(small_scene) + "CM grey  SP 0 2 8 3\n  MA blue DRF 0 0 1\n");
    EXPECT_EQ(
        run_vera(folder, "check a.vera").err,
        "a.vera:8:6: warning: material 'blue' is never used\n"
        "      MA blue DRF 0 0 1\n"
        "         ^~~~\n"
        "a.vera:7:10: warning: the view point lies inside this sphere\n"
        "    CM grey  SP 0 2 8 3\n"
        "             ^~\n"
        "  move the view point, or remove what surrounds it\n");
    const ProgramRun piped = run_vera(folder, "check - < a.vera");
    EXPECT_NE(piped.err.find("<standard input>:7:1: warning: the view point"), std::string::npos)
        << piped.err;
    folder.write(
        "b.nff",
        "v\nfrom 0 0 9\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 9 9\nl 9 9 9\n"
        "f 1 1 1 1 0 0 0 0\nf 1 1 0 1 0 0 0 0\n s 0 0 9 1\n");
    EXPECT_EQ(
        run_vera(folder, "check b.nff").err,
        "b.nff:11:2: warning: the view point lies inside this sphere\n"
        "     s 0 0 9 1\n"
        "     ^\n"
        "  move the view point, or remove what surrounds it\n");
}

TEST(CheckCommand, GivesDiagnosticsAsJson) {
    const ScratchFolder folder;
    folder.write("a.vera", "PROJECTION 0 2 8  -2 0 0  2 0 0  -2 4 0\nSP 0 1 blue 1\n");
    const ProgramRun run = run_vera(folder, "check a.vera --json");
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.out.find("\"line\": 2"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("\"column\": 8"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("\"good\": false"), std::string::npos) << run.out;
}

TEST(CheckCommand, NamesTheSceneThatHoldsNothing) {
    const ScratchFolder folder;
    folder.write("a.vera", "(* nothing *)");
    const ProgramRun run = run_vera(folder, "check a.vera");
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_EQ(
        run.err,
        "a.vera: error: the scene holds nothing that could be framed\n  add some geometry\n");
}

TEST(CheckCommand, ReadsTheControlFileToo) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    folder.write("a.ctl", "RASTER 512 0\n");
    const ProgramRun run = run_vera(folder, "check a.vera -c a.ctl");
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.err.find("a.ctl:1:12: error: "), std::string::npos) << run.err;
}

} // namespace
} // namespace vera
