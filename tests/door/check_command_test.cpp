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

TEST(CheckCommand, CountsNotesOfSolidsAndShowsThemWhenStrict) {
    const ScratchFolder folder;
    folder.write("a.vera", std::string(small_scene) + "CM grey\nP3 -1 -1 0  1 -1 0  0 1 0\n");
    const ProgramRun run = run_vera(folder, "check a.vera");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out, "a.vera: good, with 2 notes (--strict shows them)\n");
    EXPECT_EQ(run.err, "");
    const ProgramRun strict = run_vera(folder, "check a.vera --strict");
    EXPECT_EQ(strict.exit_code, 0);
    EXPECT_EQ(strict.out, "a.vera: good, with 2 notes\n");
    EXPECT_EQ(
        strict.err,
        "a.vera:8:1: note: this face or mesh passes through that of line 4\n"
        "    P3 -1 -1 0  1 -1 0  0 1 0\n"
        "    ^~\n"
        "a.vera:8:1: note: this face or mesh passes through the sphere of line 5\n"
        "    P3 -1 -1 0  1 -1 0  0 1 0\n"
        "    ^~\n");
    EXPECT_NE(
        run_vera(folder, "check a.vera --strict --json").out.find("\"severity\": \"note\""),
        std::string::npos);
}

TEST(CheckCommand, SpeaksOfAnInnerPointOnceAndOfTheFirstFewOfAKind) {
    const ScratchFolder folder;
    std::string text = std::string(small_scene)
        + "IP 2.5 5 2.5  CM grey\n"
          "P4 2 0 2  2 1 2  3 1 2  3 0 2\nP4 2 0 3  3 0 3  3 1 3  2 1 3\n"
          "P4 2 0 2  3 0 2  3 0 3  2 0 3\nP4 2 1 2  2 1 3  3 1 3  3 1 2\n"
          "P4 2 0 2  2 0 3  2 1 3  2 1 2\nP4 3 0 2  3 1 2  3 1 3  3 0 3\n";
    folder.write("a.vera", text);
    const ProgramRun run = run_vera(folder, "check a.vera");
    EXPECT_EQ(run.err.find("inner point"), run.err.rfind("inner point is on")) << run.err;
    EXPECT_NE(run.err.find("a.vera:11:1: warning: the inner point"), std::string::npos) << run.err;
    for (int i = 0; i < 13; ++i)
        text += "SP 9 9 9 1\n";
    folder.write("b.vera", text);
    const ProgramRun twice = run_vera(folder, "check b.vera");
    EXPECT_NE(
        twice.err.find("b.vera:15:1: warning: the same sphere stands in line 14 already\n"),
        std::string::npos)
        << twice.err;
    EXPECT_NE(
        twice.err.find("b.vera: warning: 2 more things that stand in the text twice\n"),
        std::string::npos)
        << twice.err;
}

/// A glass block and a pyramid in the dark: an inner point outside, things that stand twice, and a
/// face that is turned.
const char* const bad_scene = "(* Without light. *)\n"
                              "PROJECTION 0 2 8  -2 0 0  2 0 0  -2 4 0\n"
                              "CM glass\n"
                              "IP 0.5   3  0.5   (* meant to be inside *)\n"
                              "P4 0 0 0  0 1 0  1 1 0  1 0 0\n"
                              "P4 0 0 1  1 0 1  1 1 1  0 1 1\n"
                              "P4 0 0 0  1 0 0  1 0 1  0 0 1   (* the floor *)\n"
                              "P4 0 1 0  0 1 1  1 1 1  1 1 0\n"
                              "P4 0 0 0  0 0 1  0 1 1  0 1 0\n"
                              "P4 1 0 0  1 1 0  1 1 1  1 0 1\n"
                              "SP 2 2 2 0.5  SP 3 3 3 0.5  SP 2 2 2 0.5\n"
                              "SSC pyramid TR 3 0 0\n"
                              "SCENE pyramid\n"
                              "  P3 0 0 0  0 1 0  1 0 0   P3 0 0 0  1 0 0  0 0 1 (* base *)\n"
                              "  P3 0 0 0  (* back *) 0 1 0\n"
                              "            0 0 1\n"
                              "  P3 1 0 0  0 1 0  0 0 1\n"
                              "    SP 9 9 9 1\n"
                              "    SP 9 9 9 1\n"
                              "MA glass TAB 0.9 0.9 0.9 REF 1.5\n";

TEST(CheckCommand, ProposesCorrectionsAsADiff) {
    const ScratchFolder folder;
    folder.write("a.vera", bad_scene);
    const ProgramRun run = run_vera(folder, "check a.vera --fix");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(
        run.out,
        "--- a/a.vera\n"
        "+++ b/a.vera\n"
        "@@ -1,20 +1,20 @@\n"
        " (* Without light. *)\n"
        "+LI -4.8 8.72 8  143.2  1 1 1\n"
        " PROJECTION 0 2 8  -2 0 0  2 0 0  -2 4 0\n"
        " CM glass\n"
        "-IP 0.5   3  0.5   (* meant to be inside *)\n"
        "+IP 0.5   0.5  0.5   (* meant to be inside *)\n"
        " P4 0 0 0  0 1 0  1 1 0  1 0 0\n"
        " P4 0 0 1  1 0 1  1 1 1  0 1 1\n"
        " P4 0 0 0  1 0 0  1 0 1  0 0 1   (* the floor *)\n"
        " P4 0 1 0  0 1 1  1 1 1  1 1 0\n"
        " P4 0 0 0  0 0 1  0 1 1  0 1 0\n"
        " P4 1 0 0  1 1 0  1 1 1  1 0 1\n"
        "-SP 2 2 2 0.5  SP 3 3 3 0.5  SP 2 2 2 0.5\n"
        "+SP 2 2 2 0.5  SP 3 3 3 0.5\n"
        " SSC pyramid TR 3 0 0\n"
        " SCENE pyramid\n"
        "   P3 0 0 0  0 1 0  1 0 0   P3 0 0 0  1 0 0  0 0 1 (* base *)\n"
        "-  P3 0 0 0  (* back *) 0 1 0\n"
        "-            0 0 1\n"
        "+  P3 0 0 0  (* back *) 0 0 1\n"
        "+            0 1 0\n"
        "   P3 1 0 0  0 1 0  0 0 1\n"
        "     SP 9 9 9 1\n"
        "-    SP 9 9 9 1\n"
        " MA glass TAB 0.9 0.9 0.9 REF 1.5\n");
    EXPECT_NE(run.err.find("a.vera: corrects 5 findings\n"), std::string::npos) << run.err;
    EXPECT_EQ(folder.read("a.vera"), bad_scene);
}

TEST(CheckCommand, ProposesWhatPatchTakesInFoldersToo) {
    const ScratchFolder folder;
    std::filesystem::create_directories(folder.path() / "some models");
    folder.write("some models/a.vera", bad_scene);
    const ProgramRun run =
        run_vera(folder, "check './some models/../some models/a.vera' --fix -q | patch -s -p1");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(folder.read("some models/a.vera"), bad_scene);
    EXPECT_EQ(run_vera(folder, "check 'some models/a.vera' --fix").out, "");

    // By its whole path, from its folder's parent and from elsewhere.
    for (const char* from : {".", "some models", "elsewhere"}) {
        std::filesystem::create_directories(folder.path() / from);
        folder.write("some models/a.vera", bad_scene);
        const std::string patched = std::string(from) == "elsewhere" ? "../some models" : ".";
        const ProgramRun by_path = run_vera(
            folder,
            "check '" + (folder.path() / "some models/a.vera").string() + "' --fix | (cd '"
                + patched + "' && patch -s -p1)",
            std::string("cd '") + from + "' &&");
        EXPECT_EQ(by_path.exit_code, 0) << from << by_path.err;
        EXPECT_EQ(
            by_path.err.find("the diff is for 'patch -p1' in the folder of ") == std::string::npos,
            patched == ".")
            << by_path.err;
        EXPECT_NE(folder.read("some models/a.vera"), bad_scene) << from;
    }
}

TEST(CheckCommand, PlacesEachOfSeveralItemsOfALine) {
    const ScratchFolder folder;
    folder.write(
        "a.vera",
        std::string(small_scene)
            + "CM grey P3 0 0 0 1 0 0 0 1 1  P3 0 0 0 1 0 0 0 1 1  P3 0 0 0 1 0 0 0 1 1\n");
    const ProgramRun run = run_vera(folder, "check a.vera");
    for (const char* place : {"a.vera:7:31: ", "a.vera:7:53: "})
        EXPECT_NE(
            run.err.find(place + std::string("warning: the same face stands in line 7 already")),
            std::string::npos)
            << run.err;
    const ProgramRun explained = run_vera(folder, "explain a.vera 3 3 --raster 8x8");
    EXPECT_EQ(explained.exit_code, 0);
}

TEST(CheckCommand, NamesTheFaceOfAMeshFile) {
    const ScratchFolder folder;
    folder.write(
        "a.obj",
        "# two squares and a triangle, which stands twice\n"
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n\n"
        "f 1 1 2\n"
        "f 1 2 \\\n3 4\n"
        "f 1 3 4\n");
    const ProgramRun run = run_vera(folder, "check a.obj --strict");
    EXPECT_NE(
        run.err.find(
            "a.obj:10:1: note: 1 triangle of this mesh stands in the same place as another "
            "face (at triangle 3)\n    f 1 3 4\n    ^\n"),
        std::string::npos)
        << run.err;
    folder.write("a.vera", std::string(small_scene) + "CM grey MESH \"a.obj\"\n");
    const ProgramRun within = run_vera(folder, "check a.vera --strict");
    EXPECT_NE(
        within.err.find("a.vera:7:9: note: 1 triangle of this mesh stands in the same place as "
                        "another face (at triangle 3)\n"),
        std::string::npos)
        << within.err;
}

/// The part of the pixels that are not black, of a picture written as PPM.
double lit_part(const std::string& ppm, std::size_t pixels) {
    std::size_t lit = 0;
    for (std::size_t i = 0; i < pixels; ++i)
        lit += ppm.substr(ppm.size() - 3 * (i + 1), 3) != std::string(3, '\0') ? 1 : 0;
    return static_cast<double>(lit) / static_cast<double>(pixels);
}

TEST(CheckCommand, LightsWhatTheViewerSeesInAClosedRoomToo) {
    const ScratchFolder folder;
    std::string room;
    {
        std::ifstream file(VERA_SOURCE_DIR "/scenes/mirror_room.vera");
        for (std::string line; std::getline(file, line);)
            if (!line.starts_with("LI "))
                room += line + "\n";
    }
    // The same, small and far from the origin.
    const std::string far =
        "PROJECTION 5000.1 3000.4 7000.5  5000.1 3000.4 7000.4  5000.2 3000.4 "
        "7000.4  5000.1 3000.5 7000.4\n"
        "CM a SSC box TR 5000 3000 7000\n"
        "SCENE box P4 0 0 0  1 0 0  1 1 0  0 1 0  P4 0 0 1  1 0 1  1 1 1  0 1 1\n"
        "P4 0 0 0  1 0 0  1 0 1  0 0 1  P4 0 1 0  1 1 0  1 1 1  0 1 1\n"
        "P4 0 0 0  0 1 0  0 1 1  0 0 1  P4 1 0 0  1 1 0  1 1 1  1 0 1\n"
        "MA a DRF 0.7 0.7 0.7\n";
    const std::string open = std::string(small_scene).erase(40, 19);

    const struct {
        std::string text;
        double seen; // the part of the picture that shows something
    } scenes[] = {{room, 1}, {far, 1}, {open, 0.48}};

    for (const auto& [text, seen] : scenes) {
        folder.write("a.vera", text);
        ASSERT_NE(run_vera(folder, "check a.vera").err.find("there is no light"), std::string::npos)
            << text;
        const ProgramRun run = run_vera(folder, "check a.vera --fix --write b.vera");
        ASSERT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(run_vera(folder, "check b.vera").err, "");
        const std::string render = "-o x.ppm --raster 24x18 --antialias off --ambient 0 0 0 -q";
        ASSERT_EQ(run_vera(folder, "render a.vera " + render).exit_code, 0);
        EXPECT_EQ(lit_part(folder.read("x.ppm"), 432), 0);
        ASSERT_EQ(run_vera(folder, "render b.vera " + render).exit_code, 0);
        const double lit = lit_part(folder.read("x.ppm"), 432);
        EXPECT_GT(lit, 0.6 * seen) << folder.read("b.vera");
    }
}

TEST(CheckCommand, WritesACorrectedSceneInWhichNothingIsLeftToCorrect) {
    const ScratchFolder folder;
    folder.write("a.vera", bad_scene);
    const ProgramRun run = run_vera(folder, "check a.vera --fix --write b.vera");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out, "");
    const ProgramRun again = run_vera(folder, "check b.vera --strict");
    EXPECT_EQ(again.out, "b.vera: good\n");
    EXPECT_EQ(again.err, "");
    const ProgramRun fixed = run_vera(folder, "check b.vera --fix");
    EXPECT_EQ(fixed.out, "");
    EXPECT_EQ(fixed.err, "b.vera: nothing to correct\n");
}

TEST(CheckCommand, MovesTheInnerPointOfThePapersExample) {
    const ScratchFolder folder;
    const std::string still_life = VERA_SOURCE_DIR "/scenes/still_life.vera";
    EXPECT_NE(run_vera(folder, "check " + still_life).err.find("inner point"), std::string::npos);
    const ProgramRun run = run_vera(folder, "check " + still_life + " --fix --write b.vera");
    EXPECT_NE(run.err.find("corrected 1 finding\n"), std::string::npos) << run.err;
    EXPECT_EQ(run_vera(folder, "check b.vera").err, "");
}

TEST(CheckCommand, SaysWhatItCannotCorrect) {
    const ScratchFolder folder;
    std::string text = bad_scene;
    folder.write(
        "a.vera",
        text.insert(text.find("IP"), "INCLUDE \"part.vera\" (*")
            .insert(text.find("inside *)"), "*) (* "));
    folder.write("part.vera", "IP 0.5 3 0.5\n");
    const ProgramRun run = run_vera(folder, "check a.vera --fix");
    EXPECT_NE(
        run.err.find("a.vera: corrects 4 findings; 1 finding cannot be corrected without knowing "
                     "more: see its remedy\n"),
        std::string::npos)
        << run.err;
}

TEST(CheckCommand, FixesNothingButScenesOfTheLanguage) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    for (const char* arguments :
         {"check a.vera --write b.vera",
          "check - --fix < a.vera",
          "check a.nff --fix",
          "check a.vera --fix --json"}) {
        const ProgramRun run = run_vera(folder, arguments);
        EXPECT_EQ(run.exit_code, 2) << arguments;
        EXPECT_NE(run.err.find("--fix"), std::string::npos) << run.err;
    }
    EXPECT_EQ(run_vera(folder, "check a.vera --fix --write no/b.vera").exit_code, 3);
    EXPECT_EQ(folder.file_count(), 1U);
}

TEST(CheckCommand, WarnsOfALightThatSomethingOpaqueSurrounds) {
    const ScratchFolder folder;
    folder.write("a.vera", std::string(small_scene) + "CM grey SP 3 6 5 0.5\n");
    EXPECT_EQ(
        run_vera(folder, "check a.vera").err,
        "a.vera:7:9: warning: a light lies inside this sphere, which keeps it in\n"
        "    CM grey SP 3 6 5 0.5\n"
        "            ^~\n"
        "  move the light, let light through (TAB), or leave out SHADOWS\n");
    EXPECT_EQ(run_vera(folder, "check a.vera --shadows off").err, "");
    folder.write("b.vera", std::string(small_scene) + "CM glass SP 3 6 5 0.5 MA glass TAB 1 1 1\n");
    EXPECT_EQ(run_vera(folder, "check b.vera").err, "");
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
