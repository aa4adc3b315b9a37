// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "door/program.h"
#include <nlohmann/json.hpp>

namespace vera {
namespace {

/// Two lights, red and white, a mirror, glass, something that glows, and a sky.
const char* const lit_scene = "PROJECTION 0 2 8  -2 0 0  2 0 0  -2 4 0\n"
                              "LI 3 6 5  20 1 0.2 0.1\n"
                              "LI -3 6 5  20 1 1 1\n"
                              "CM grey\n"
                              "P4 -9 0 9  9 0 9  9 0 -9  -9 0 -9\n"
                              "CM mirror SP 0 1.5 -1 1.5\n"
                              "CM glass SP -1.5 2 1 0.5\n"
                              "CM lamp SP 2 0.5 1 0.5\n"
                              "MA grey DRF 0.7 0.7 0.7\n"
                              "MA mirror RAB 0.5 0.5 0.5 DRF 0.2 0.2 0.2 SPC 0.9\n"
                              "MA glass TAB 0.9 0.8 0.7 REF 1.5\n"
                              "MA lamp SDI 0.2 0.1 0 DRF 0.3 0.3 0.3\n";
const char* const settings =
    "RASTER 48 40 RTDEPTH 3 AMBIENT 0.1 0.1 0.1 SKY 0.1 0.2 0.4 SHADOWS LIGHTS 0.5 2\n";

class SolveCommand : public ::testing::Test {
protected:
    SolveCommand() {
        folder.write("a.vera", lit_scene);
        folder.write("a.ctl", settings);
        EXPECT_EQ(
            run_vera(folder, "render a.vera -c a.ctl -o a.ppm --layers a.exr -q").exit_code, 0);
    }

    ProgramRun solve(const std::string& options) const {
        return run_vera(folder, "solve a.exr -o solved.ctl " + options);
    }

    /// The bytes of the picture with the control file that was solved.
    std::vector<unsigned char> picture() const {
        const ProgramRun run = run_vera(folder, "render a.vera -c solved.ctl -o solved.ppm -q");
        EXPECT_EQ(run.exit_code, 0) << run.err << folder.read("solved.ctl");
        const std::string file = folder.read("solved.ppm");
        const std::string pixels = file.substr(file.size() - std::size_t{3} * 48 * 40);
        return {pixels.begin(), pixels.end()};
    }

    ScratchFolder folder;
};

double mean(const std::vector<unsigned char>& picture, int x, int y, int width, int height) {
    double sum = 0;
    for (int row = y; row < y + height; ++row)
        for (int sample = 3 * x; sample < 3 * (x + width); ++sample)
            sum +=
                picture[3 * 48 * static_cast<std::size_t>(row) + static_cast<std::size_t>(sample)];
    return sum / 255 / (3.0 * width * height);
}

TEST_F(SolveCommand, GivesARectangleTheMeanThatIsWanted) {
    for (const char* wanted : {"0.2", "0.3"}) {
        const ProgramRun run = solve(std::string("--mean 0 28 48 12 ") + wanted);
        EXPECT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(run.err.find("warning"), std::string::npos) << run.err;
        EXPECT_NEAR(mean(picture(), 0, 28, 48, 12), std::stod(wanted), 0.5 / 255) << run.err;
    }
}

TEST_F(SolveCommand, FindsTheLightsThatAPictureWasMadeWith) {
    folder.write(
        "solved.ctl",
        "RASTER 48 40 RTDEPTH 3 AMBIENT 0.1 0.1 0.1 SKY 0.1 0.2 0.4 SHADOWS "
        "LIGHTS 1.5 1\n");
    const auto wanted = picture();
    std::string places;
    for (const char* place : {" 2 37", " 4 37", " 44 37"}) {
        const ProgramRun told =
            run_vera(folder, std::string("explain a.vera -c solved.ctl --json") + place);
        places += std::string(" --place") + place;
        const auto json = nlohmann::json::parse(told.out);
        for (const double part : json["color"])
            places += ' ' + std::to_string(part);
    }
    const ProgramRun run = solve(places);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err.find("warning"), std::string::npos) << run.err;
    const auto bytes = picture();
    int farthest = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i)
        farthest = std::max(farthest, std::abs(bytes[i] - wanted[i]));
    EXPECT_LE(farthest, 1) << folder.read("solved.ctl");
}

TEST_F(SolveCommand, ChangesOnlyTheLightsThatItMay) {
    ASSERT_EQ(solve("--mean 0 28 48 12 0.3 --lights 2").exit_code, 0);
    const std::string control = folder.read("solved.ctl");
    EXPECT_NE(control.find(" LIGHTS 0.5 "), std::string::npos) << control;
    EXPECT_NE(control.find(" AMBIENT 0.1 0.1 0.1"), std::string::npos) << control;
    EXPECT_NEAR(mean(picture(), 0, 28, 48, 12), 0.3, 0.5 / 255);
    ASSERT_EQ(solve("--mean 0 28 48 12 0.3 --ambient").exit_code, 0);
    EXPECT_EQ(folder.read("solved.ctl").find(" AMBIENT 0.1 0.1 0.1"), std::string::npos);
    EXPECT_NEAR(mean(picture(), 0, 28, 48, 12), 0.3, 0.5 / 255);
}

TEST_F(SolveCommand, ScalesAllLightToAnExposure) {
    ASSERT_EQ(solve("--exposure 0.6").exit_code, 0);
    std::vector<int> brightest;
    const auto bytes = picture();
    // Everything but the sky is seen, and it fills less than a half.
    for (std::size_t i = std::size_t{3} * 48 * 18; i < bytes.size(); i += 3)
        brightest.push_back(std::max({bytes[i], bytes[i + 1], bytes[i + 2]}));
    const auto brighter = std::count_if(
        brightest.begin(), brightest.end(), [](int value) { return value > 0.6 * 255 + 1; });
    EXPECT_LT(static_cast<double>(brighter), 0.06 * static_cast<double>(brightest.size()));
    EXPECT_GT(*std::max_element(brightest.begin(), brightest.end()), 0.6 * 255 - 1);
}

TEST_F(SolveCommand, TakesTheExposureOfTheLayersAlong) {
    ASSERT_EQ(
        run_vera(folder, "render a.vera -c a.ctl --exposure 0.5 -o e.ppm --layers a.exr -q")
            .exit_code,
        0);
    // As it is: the mean that the picture has already.
    const std::string file = folder.read("e.ppm");
    const std::string pixels = file.substr(file.size() - std::size_t{3} * 48 * 40);
    const std::vector<unsigned char> before(pixels.begin(), pixels.end());
    const double wanted = mean(before, 0, 28, 48, 12);
    ASSERT_EQ(solve("--mean 0 28 48 12 " + std::to_string(wanted)).exit_code, 0);
    EXPECT_EQ(folder.read("solved.ctl").find("EXPMES"), std::string::npos);
    EXPECT_NEAR(mean(picture(), 0, 28, 48, 12), wanted, 0.5 / 255);
}

TEST_F(SolveCommand, WarnsWhereAWishCannotBeMet) {
    const ProgramRun run = solve("--mean 0 28 48 12 0.9 --most 1.5");
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_NE(run.err.find("warning: they cannot all be met"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("light 1 times 1.5"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("light 2 times 1.5"), std::string::npos) << run.err;
}

TEST_F(SolveCommand, RefusesWhatItCannotSolve) {
    folder.write("b.exr", "no picture");
    folder.write("cut.exr", folder.read("a.exr").substr(0, 500));
    ASSERT_EQ(run_vera(folder, "render a.vera --raster 8x8 -o plain.exr -q").exit_code, 0);

    const struct {
        const char* arguments;
        const char* problem;
        int exit_code;
    } wrong[] = {
        {"a.exr", "say what is wanted: --place, --mean or --exposure", 2},
        {"a.exr --exposure 0.5 --mean 0 0 1 1 1", "--exposure scales all light at once", 2},
        {"a.exr --exposure 0.5 --most 2", "leave out --lights, --ambient, --least and --most", 2},
        {"a.exr --place 1 2 3", "--place takes five numbers, X Y R G B; found 3", 2},
        {"a.exr --place 48 2 1 1 1", "X of --place takes a whole number from 0 to 47", 2},
        {"a.exr --mean 40 0 9 1 1", "W of --mean takes a whole number from 1 to 8; found 9", 2},
        {"a.exr --mean 0 0 1 1 1 --lights 3", "--lights takes a whole number from 1 to 2", 2},
        {"a.exr --mean 0 0 1 1 1 --least 2 --most 1", "--least must not be more than --most", 2},
        {"a.exr --exposure 2", "--exposure takes a number from", 2},
        {"b.exr --exposure 1", "b.exr: error: this is no EXR file, and layers are in one", 1},
        {"b.exr --exposure 1", "name the EXR file that 'vera render SCENE -o PICTURE --layers", 1},
        {"cut.exr --exposure 1",
         "name the EXR file that 'vera render SCENE -o PICTURE --layers",
         1},
        {"plain.exr --exposure 1", "plain.exr: error: ", 1},
        {"none.exr --exposure 1", "none.exr", 3},
    };

    for (const auto& [arguments, problem, exit_code] : wrong) {
        const ProgramRun run = run_vera(folder, std::string("solve -o x.ctl ") + arguments);
        EXPECT_EQ(run.exit_code, exit_code) << arguments << run.err;
        EXPECT_NE(run.err.find(problem), std::string::npos) << run.err;
        EXPECT_EQ(folder.read("x.ctl"), "") << arguments;
    }

    const std::string layers = folder.read("a.exr");
    const ProgramRun over = run_vera(folder, "solve a.exr -o ./a.exr --exposure 0.5");
    EXPECT_EQ(over.exit_code, 2);
    EXPECT_NE(over.err.find("'./a.exr' holds the layers: name another file"), std::string::npos)
        << over.err;
    EXPECT_EQ(folder.read("a.exr"), layers);
}

} // namespace
} // namespace vera
