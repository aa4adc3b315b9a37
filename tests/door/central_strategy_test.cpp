// SPDX-License-Identifier: Apache-2.0
// vera render --strategy central, by the program as users run it.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "door/picture.h"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace vera {
namespace {

/// Plane faces that pass through each other, lie upon each other and throw shadows, some behind the
/// viewer, in subscenes as well.
const char* const plane_scene = "PROJECTION 1 4 12  -4 -1 0  4 -1 0  -4 5 0\n"
                                "LI 5 9 8  150 1 1 1\n"
                                "LI -6 7 3  60 1 0.8 0.6\n"
                                "LI 2 6 30  900 1 1 1\n"
                                "CM grey\n"
                                "PN 6  -2 0 1  0 0 1  0 0 3  -1 0 2  -1.5 0 3  -2 0 2\n"
                                "CM floor\n"
                                "P4 -9 0 9  9 0 9  9 0 -9  -9 0 -9\n"
                                "CM grey\n"
                                "SSC tent TR -1 0 0\n"
                                "SSC tent RT 0 50 0 TR 2 0.4 0.2\n"
                                "SSC tent SC 3 TR 2 3 18\n"
                                "P3 -3 0.5 2  3 1 -3  0 2.5 0\n"
                                "MA grey DRF 0.7 0.7 0.5 ARF 0.1 0.1 0.1\n"
                                "MA floor DRF 0.5 0.3 0.2\n"
                                "MA unused DRF 1 1 1 TAB 1 1 1\n"
                                "SCENE tent\n"
                                "P3 -1 0 1  1 0 1  0 2 0\n"
                                "P3 1 0 1  1 0 -1  0 2 0\n"
                                "P3 1 0 -1  -1 0 -1  0 2 0\n"
                                "P3 -1 0 -1  -1 0 1  0 2 0\n";

TEST(CentralStrategy, GivesThePictureOfRaysOfPlaneFaces) {
    const ScratchFolder folder;
    folder.write("a.vera", plane_scene);
    for (const char* options :
         {" --raster 161x121 --antialias off",
          " --raster 127x95 --antialias off --shadows off",
          " --raster 61x45"}) {
        const auto expected = picture(folder, "a.vera", options);
        const auto found = picture(folder, "a.vera", std::string("--strategy central") + options);
        ASSERT_EQ(found.size(), expected.size());
        // Of 19 481 pixels, 12 065 and 2745, with four rays and more each.
        EXPECT_LE(different_pixels(found, expected), 2U) << options;
    }
}

class CentralStrategyOfExample : public testing::TestWithParam<const char*> {};

TEST_P(CentralStrategyOfExample, DiffersFromRaysAtFewPixelsAndNotWithThreads) {
    const ScratchFolder folder;
    const std::string scene = std::string(VERA_SOURCE_DIR "/scenes/") + GetParam();
    const std::string options =
        scene + ".vera -c " + scene + ".ctl --raster 80x60 --depth 1 --antialias off";
    const auto expected = picture(folder, options, "");
    const auto found = picture(folder, options, "--strategy central");
    ASSERT_EQ(found.size(), expected.size());
    // Curved surfaces have facets that lie a 64th of a pixel off them, and more in their shadows.
    EXPECT_LE(different_pixels(found, expected), 6U);
    EXPECT_TRUE(picture(folder, options, "--strategy central --threads 1") == found);
}

INSTANTIATE_TEST_SUITE_P(
    Examples,
    CentralStrategyOfExample,
    testing::Values("still_life", "temple"),
    [](const auto& test) { return std::string(test.param); });

TEST(CentralStrategy, CountsAQueryForEachPixelAndForEachLightThatShinesOnIt) {
    const ScratchFolder folder;
    folder.write(
        "a.vera",
        "PROJECTION 0 0 5  -1 -1 4  1 -1 4  -1 1 4\n"
        "LI 1 2 9 80 1 1 1 LI -2 0 9 80 1 1 1\n"
        "P4 -9 -9 0  9 -9 0  9 9 0  -9 9 0  P3 -0.5 0 1  0.5 0 1  0 0.6 1.5\n");
    const ProgramRun run = run_vera(
        folder, "render a.vera --raster 32x24 --antialias off --strategy central --json -o a.ppm");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto report = nlohmann::json::parse(run.out);
    EXPECT_EQ(report["rays"]["view_rays"], 32 * 24);
    EXPECT_EQ(report["rays"]["shadow_rays"], 2 * 32 * 24);
    EXPECT_EQ(report["tests"], 3 * 32 * 24);
    EXPECT_GT(report["cells"], 3 * 32 * 24);
    EXPECT_GT(report["index_bytes"], 1000);
}

TEST(CentralStrategy, RefusesRaysThatStartAnywhere) {
    const ScratchFolder folder;
    const std::string head = "PROJECTION 0 0 5  -1 -1 4  1 -1 4  -1 1 4 LI 1 2 9 80 1 1 1\n";
    const std::string face = "P3 -1 -1 0  1 -1 0  0 1 0\n";
    folder.write("mirror.vera", head + "CM m " + face + "MA m DRF 1 1 1 RAB 0.5 0.5 0.5\n");
    folder.write("glass.vera", head + "CM g " + face + "MA g TAB 0.5 0.5 0.5 REF 1.5\n");
    folder.write(
        "parallel.vera", "PARALLEL 0 0 -1  -1 -1 4  1 -1 4  -1 1 4 LI 1 2 9 80 1 1 1\n" + face);

    const struct {
        const char* options;
        const char* message;
    } wrong[] = {
        {"mirror.vera",
         "--strategy central answers rays from the viewer and the lights alone, and material 'm' "
         "mirrors (RAB): give --depth 1, which leaves mirrored rays out, or leave --strategy out"},
        {"glass.vera", "material 'g' lets light through (TAB): leave --strategy out"},
        {"glass.vera --depth 1", "material 'g' lets light through (TAB)"},
        {"parallel.vera", "those of PARALLEL have none in common: give a PROJECTION"},
        {"mirror.vera --depth 1 --index grid", "needs no index: leave --index out"},
    };

    for (const auto& [options, message] : wrong) {
        const ProgramRun run =
            run_vera(folder, std::string("render --strategy central -o a.png ") + options);
        EXPECT_EQ(run.exit_code, 2) << options;
        EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
    }
    EXPECT_EQ(folder.file_count(), 3U);
    for (const char* good : {"mirror.vera --depth 1", "glass.vera --depth 1 --shadows off"})
        EXPECT_EQ(
            run_vera(folder, std::string("render --strategy central -q -o a.png ") + good)
                .exit_code,
            0)
            << good;
}

TEST(CentralStrategy, TellsWhatItDoesNotSee) {
    const ScratchFolder folder;
    folder.write(
        "a.vera",
        "PROJECTION 0 1 0  -1 -1 -1  1 -1 -1  -1 1 -1\n"
        "P4 -1e6 0 1  1e6 0 1  1e6 0 -1e6  -1e6 0 -1e6\n"
        "P3 -1e-6 0.9999999 -1e-6  1e-6 0.9999999 -1e-6  0 0.9999999 -2e-6\n"
        "LI 0 9 0 99 1 1 1\n");
    const ProgramRun run =
        run_vera(folder, "render a.vera --raster 20x10 --strategy central -o a.ppm");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.err.find("what is nearer to the view point than "), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("--strategy rays sees it"), std::string::npos) << run.err;
}

} // namespace
} // namespace vera
