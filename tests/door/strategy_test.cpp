// SPDX-License-Identifier: Apache-2.0
// The three strategies of a picture, by the program as users run it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "door/picture.h"

namespace vera {
namespace {

/// Plane faces alone, one of them concave, that pass through each other, lie upon each other,
/// mirror, let light through and cast shadows.
const char* const plane_scene = "PROJECTION 1 4 12  -4 -1 0  4 -1 0  -4 5 0\n"
                                "LI 5 9 8  150 1 1 1\n"
                                "LI -6 7 3  60 1 0.8 0.6\n"
                                "CM grey\n"
                                "PN 6  -2 0 1  0 0 1  0 0 3  -1 0 2  -1.5 0 3  -2 0 2\n"
                                "CM floor\n"
                                "P4 -9 0 9  9 0 9  9 0 -9  -9 0 -9\n"
                                "CM mirror\n"
                                "P4 -4 0 -3  4 0 -4  4 6 -4  -4 6 -3\n"
                                "CM glass\n"
                                "P4 0.3 0 2  2.3 0 2.4  2.4 2 2.2  0.2 2.1 1.8\n"
                                "CM grey\n"
                                "SSC tent TR -1 0 0\n"
                                "SSC tent RT 0 50 0 TR 2 0.4 0.2\n"
                                "P3 -3 0.5 2  3 1 -3  0 2.5 0\n"
                                "MA grey DRF 0.7 0.7 0.5 ARF 0.1 0.1 0.1\n"
                                "MA floor DRF 0.5 0.3 0.2\n"
                                "MA mirror DRF 0.1 0.1 0.1 RAB 0.8 0.7 0.7\n"
                                "MA glass DRF 0.1 0.1 0.1 TAB 0.7 0.9 0.8 REF 1\n"
                                "SCENE tent\n"
                                "P3 -1 0 1  1 0 1  0 2 0\n"
                                "P3 1 0 1  1 0 -1  0 2 0\n"
                                "P3 1 0 -1  -1 0 -1  0 2 0\n"
                                "P3 -1 0 -1  -1 0 1  0 2 0\n";

TEST(Strategy, GivesTheSamePictureOfPlaneFacesToTheByte) {
    // Of rasters in which no pixel has its middle on an edge.
    const ScratchFolder folder;
    folder.write("a.vera", plane_scene);
    for (const char* options :
         {" --raster 81x61 --antialias off --depth 3",
          " --raster 127x95 --antialias off --shadows off"}) {
        const auto expected = picture(folder, "a.vera", options);
        for (const char* strategy : {"visible", "depth"}) {
            const auto found =
                picture(folder, "a.vera", std::string("--strategy ") + strategy + options);
            ASSERT_EQ(found.size(), expected.size());
            EXPECT_EQ(different_pixels(found, expected), 0U) << strategy << options;
        }
    }
}

class StrategyOfExample : public testing::TestWithParam<const char*> {};

TEST_P(StrategyOfExample, DiffersFromRaysAtSilhouettesOfCurvedThingsAlone) {
    const ScratchFolder folder;
    const std::string scene = std::string(VERA_SOURCE_DIR "/scenes/") + GetParam();
    const std::string options = "-c " + scene + ".ctl --raster 80x60 --antialias off";
    const auto expected = picture(folder, scene + ".vera", options);
    for (const char* strategy : {"visible", "depth"}) {
        const auto found = picture(folder, scene + ".vera", options + " --strategy " + strategy);
        ASSERT_EQ(found.size(), expected.size());
        // A facet lies up to a 64th of a pixel off a silhouette; of the 4800 pixels some hundreds
        // lie on one.
        EXPECT_LE(different_pixels(found, expected), 8U) << strategy;
    }
}

TEST_P(StrategyOfExample, GivesTheSameBytesForAnyNumberOfThreadsAndAnyIndex) {
    const ScratchFolder folder;
    const std::string scene = std::string(VERA_SOURCE_DIR "/scenes/") + GetParam();
    for (const char* strategy : {"visible", "depth"})
        for (const char* antialias : {"on", "off"}) {
            const std::string options = "-c " + scene + ".ctl --raster 40x30 --antialias "
                + antialias + " --strategy " + strategy;
            const auto expected = picture(folder, scene + ".vera", options);
            for (const char* more : {" --threads 1", " --threads 7 --index grid", " --threads 2"})
                EXPECT_TRUE(picture(folder, scene + ".vera", options + more) == expected)
                    << options << more;
        }
}

INSTANTIATE_TEST_SUITE_P(
    Examples,
    StrategyOfExample,
    testing::Values("still_life", "flange", "glass", "polygons", "mirror_room"),
    [](const auto& test) { return std::string(test.param); });

TEST(Strategy, VisibleFillsPixelsByTheExactAreaOfWhatIsSeenInThem) {
    const ScratchFolder folder;
    // A triangle that glows in all of red, and a quadrangle before it that does not.
    folder.write(
        "a.vera",
        "PARALLEL 0 0 -1  0 0 0  10 0 0  0 10 0\n"
        "CM black P4 3.1 3 1  6 2 1  5.5 4.4 1  3 4 1\n"
        "CM red P3 1.03 1.07 0  9.11 1.9 0  3.3 8.7 0\n"
        "MA black SDI 0 0 0\n"
        "MA red SDI 1 0 0\n");
    const ProgramRun run = run_vera(
        folder, "render a.vera --raster 13x9 --strategy visible --format ppm16 -q -o a.ppm");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Image image = read_image(folder.path() / "a.ppm");
    double red = 0;
    const auto& samples = std::get<std::vector<std::uint16_t>>(image.samples);
    for (std::size_t i = 0; i < samples.size(); i += 3)
        red += samples[i] / 65535.0 / (13 * 9);
    const auto doubled = [](double x, double y, double to_x, double to_y) {
        return x * to_y - y * to_x;
    };
    const double triangle = doubled(1.03, 1.07, 9.11, 1.9) + doubled(9.11, 1.9, 3.3, 8.7)
        + doubled(3.3, 8.7, 1.03, 1.07);
    const double quadrangle = doubled(3.1, 3, 6, 2) + doubled(6, 2, 5.5, 4.4)
        + doubled(5.5, 4.4, 3, 4) + doubled(3, 4, 3.1, 3);
    EXPECT_NEAR(red, (triangle - quadrangle) / 2 / 100, 1e-5);
}

TEST(Strategy, TellsWhatItFoundAndWhatItLeftOut) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    const ProgramRun run = run_vera(
        folder,
        "render a.vera --raster 20x10 --strategy depth --antialias off --shadows off --json -o "
        "a.ppm");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("\"parts\": 200,"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("\"view_rays\": 0,"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("\"surfaces\": "), std::string::npos) << run.out;
    const ProgramRun text =
        run_vera(folder, "render a.vera --raster 20x10 --strategy depth --antialias off -o a.ppm");
    EXPECT_EQ(text.err.rfind("a.ppm: 200 parts of pixels; rays: 0 view, ", 0), 0U) << text.err;
    // A floor that begins under the viewer.
    folder.write(
        "b.vera",
        "PROJECTION 0 1 0  -1 -1 -1  1 -1 -1  -1 1 -1\n"
        "P4 -1e6 0 1  1e6 0 1  1e6 0 -1e6  -1e6 0 -1e6\n"
        "P3 -1e-6 0.9999999 -1e-6  1e-6 0.9999999 -1e-6  0 0.9999999 -2e-6\n"
        "LI 0 9 0 99 1 1 1\n");
    const ProgramRun near =
        run_vera(folder, "render b.vera --raster 20x10 --strategy visible -o b.ppm");
    EXPECT_EQ(near.exit_code, 0) << near.err;
    EXPECT_NE(near.err.find("--strategy rays shows it"), std::string::npos) << near.err;
}

TEST(Strategy, RefusesWhatMeansNothingToIt) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);

    const struct {
        const char* options;
        const char* message;
    } wrong[] = {
        {"--strategy dpeth",
         "--strategy takes rays, visible, depth, central or primitive-query; found 'dpeth'; did "
         "you "
         "mean 'depth'?"},
        {"--strategy visible --samples 16",
         "--strategy visible takes exact areas, not --samples: leave it out"},
        {"--strategy depth --tolerance 0.1",
         "--tolerance tells which pixels get more rays, and --strategy depth sends none through "
         "pixels: leave it out"},
    };

    for (const auto& [options, message] : wrong) {
        const ProgramRun run = run_vera(folder, std::string("render a.vera -o a.png ") + options);
        EXPECT_EQ(run.exit_code, 2) << options;
        EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
    }
    EXPECT_EQ(folder.file_count(), 1U);
}

} // namespace
} // namespace vera
