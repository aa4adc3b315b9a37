// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/control_file.h"

#include <gtest/gtest.h>

namespace vera {

namespace {

struct Reading {
    PictureSettings settings;
    std::string said;
};

Reading read_control(const std::string& text, const PictureSettings& defaults = {}) {
    Reading reading;
    std::vector<Diagnostic> diagnostics;
    try {
        reading.settings = read_control_text(SourceText("test.ctl", text), defaults, diagnostics);
    } catch (const InputError& error) {
        diagnostics = error.diagnostics();
    }
    for (const Diagnostic& diagnostic : diagnostics)
        reading.said += to_text(diagnostic);
    return reading;
}

TEST(ControlFile, ReadsThatOfTheStillLife) {
    std::vector<Diagnostic> warnings;
    const PictureSettings settings =
        read_control_file(VERA_SOURCE_DIR "/scenes/still_life.ctl", {}, warnings);
    EXPECT_TRUE(warnings.empty());
    EXPECT_EQ(settings.width, 512U);
    EXPECT_EQ(settings.height, 512U);
    EXPECT_EQ(settings.depth, 2U);
    EXPECT_EQ(settings.exposure, 0.0);
    EXPECT_EQ(settings.ambient, (Color{0.5, 0.5, 0.5}));
    ASSERT_TRUE(settings.firmament);
    EXPECT_EQ(settings.firmament->sky, (Color{0.2, 0.2, 0.2}));
    EXPECT_EQ(settings.firmament->horizon, (Color{0.1, 0.1, 0.2}));
    EXPECT_EQ(settings.firmament->earth, (Color{0.3, 0.3, 0.3}));
    EXPECT_TRUE(settings.shadows);
    EXPECT_TRUE(settings.antialiasing.on);
}

TEST(ControlFile, TurnsOffWhatItDoesNotName) {
    const Reading reading = read_control(" (* nothing *) ");
    EXPECT_EQ(reading.said, "");
    EXPECT_FALSE(reading.settings.shadows);
    EXPECT_FALSE(reading.settings.antialiasing.on);
    EXPECT_FALSE(reading.settings.exposure);
    EXPECT_FALSE(reading.settings.firmament);
    EXPECT_FALSE(reading.settings.frame_margin);
    EXPECT_EQ(reading.settings.width, 512U);
    EXPECT_EQ(reading.settings.depth, 2U);
}

TEST(ControlFile, KeepsTheScenesOwnDefaults) {
    PictureSettings defaults;
    defaults.depth = 5;
    defaults.firmament = Firmament{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
    const Reading reading = read_control("RASTER 3 4", defaults);
    EXPECT_EQ(reading.settings.depth, 5U);
    ASSERT_TRUE(reading.settings.firmament);
    EXPECT_EQ(reading.settings.firmament->earth, (Color{1, 2, 3}));
}

TEST(ControlFile, ReadsEveryKeywordInAnyOrder) {
    const Reading reading = read_control("TOLERANCE 0.125 SAMPLES 64 ASPECT 1.5 FRAME 0.05\n"
                                         "ANTI-ALIAS SHADOWS EARTH 1 2 3 HORIZON 4 5 6 SKY 7 8 9\n"
                                         "AMBIENT .1 .2 .3 EXPMES .75 RTDEPTH 7 RASTER 640 480");
    EXPECT_EQ(reading.said, "");
    const PictureSettings& settings = reading.settings;
    EXPECT_EQ(settings.antialiasing.tolerance, 0.125);
    EXPECT_EQ(settings.antialiasing.samples, 64U);
    EXPECT_TRUE(settings.antialiasing.on);
    EXPECT_EQ(settings.pixel_aspect, 1.5);
    EXPECT_EQ(settings.frame_margin, 0.05);
    EXPECT_TRUE(settings.shadows);
    ASSERT_TRUE(settings.firmament);
    EXPECT_EQ(settings.firmament->earth, (Color{1, 2, 3}));
    EXPECT_EQ(settings.firmament->horizon, (Color{4, 5, 6}));
    EXPECT_EQ(settings.firmament->sky, (Color{7, 8, 9}));
    EXPECT_EQ(settings.ambient, (Color{0.1, 0.2, 0.3}));
    EXPECT_EQ(settings.exposure, 0.75);
    EXPECT_EQ(settings.depth, 7U);
    EXPECT_EQ(settings.width, 640U);
    EXPECT_EQ(settings.height, 480U);
}

TEST(ControlFile, TakesHorizonFromSkyAndEarthFromHorizon) {
    const Reading sky = read_control("SKY 1 0 0");
    ASSERT_TRUE(sky.settings.firmament);
    EXPECT_EQ(sky.settings.firmament->horizon, (Color{1, 0, 0}));
    EXPECT_EQ(sky.settings.firmament->earth, (Color{1, 0, 0}));
    const Reading horizon = read_control("HORIZON 0 1 0 SKY 1 0 0");
    ASSERT_TRUE(horizon.settings.firmament);
    EXPECT_EQ(horizon.settings.firmament->earth, (Color{0, 1, 0}));
}

TEST(ControlFile, WarnsOfHorizonAndEarthWithoutSky) {
    const Reading reading = read_control("HORIZON 1 0 0 EARTH 0 1 0");
    EXPECT_FALSE(reading.settings.firmament);
    EXPECT_EQ(
        reading.said,
        "test.ctl:1:1: warning: HORIZON is ignored without SKY\n"
        "    HORIZON 1 0 0 EARTH 0 1 0\n"
        "    ^~~~~~~\n"
        "  give SKY as well: without it the whole firmament is black\n"
        "test.ctl:1:15: warning: EARTH is ignored without SKY\n"
        "    HORIZON 1 0 0 EARTH 0 1 0\n"
        "                  ^~~~~\n"
        "  give SKY as well: without it the whole firmament is black\n");
}

TEST(ControlFile, SaysWhatIsWrongAndReadsOn) {
    EXPECT_EQ(
        read_control("RASTER 512 512.5\nRASTER 3 3 SHADOW 4 5\nRTDEPTH 0 EXPMES 1.5 shadows\n")
            .said,
        "test.ctl:1:12: error: expected the picture's height in pixels, a whole number from 1 to "
        "1000000, found '512.5'\n"
        "    RASTER 512 512.5\n"
        "               ^~~~~\n"
        "test.ctl:2:1: error: RASTER is given twice\n"
        "    RASTER 3 3 SHADOW 4 5\n"
        "    ^~~~~~\n"
        "  the first stands in line 1\n"
        "test.ctl:2:12: error: expected a keyword of control files, found 'SHADOW'; did you mean "
        "'SHADOWS'?\n"
        "    RASTER 3 3 SHADOW 4 5\n"
        "               ^~~~~~\n"
        "test.ctl:3:9: error: expected RTDEPTH, a whole number from 1 to 1000, found '0'\n"
        "    RTDEPTH 0 EXPMES 1.5 shadows\n"
        "            ^\n"
        "test.ctl:3:18: error: EXPMES is 1.5, but must be from 0 to 1\n"
        "    RTDEPTH 0 EXPMES 1.5 shadows\n"
        "                     ^~~\n"
        "  0 measures only; more scales the light until bright parts of the picture get this "
        "value\n");
}

TEST(ControlFile, SaysWhereStatementsOfTheSceneBelong) {
    EXPECT_EQ(
        read_control("RASTER 5 5\nPROJECTION 0 2 8  -2 0 0  2 0 0  -2 4 0\nSHADOWS").said,
        "test.ctl:2:1: error: expected a keyword of control files, found 'PROJECTION'\n"
        "    PROJECTION 0 2 8  -2 0 0  2 0 0  -2 4 0\n"
        "    ^~~~~~~~~~\n"
        "  PROJECTION belongs in the scene\n");
}

TEST(ControlFile, BoundsItsExtensions) {
    EXPECT_EQ(
        read_control("FRAME 0.5").said,
        "test.ctl:1:7: error: the margin of FRAME is 0.5, but must be at least 0 and less than "
        "0.5\n"
        "    FRAME 0.5\n"
        "          ^~~\n"
        "  it is the part of the picture that stays free on each side, for example 0.05\n");
    EXPECT_EQ(
        read_control("ASPECT 0").said,
        "test.ctl:1:8: error: ASPECT is 0, but must be from 0.001 to 1000\n"
        "    ASPECT 0\n"
        "           ^\n"
        "  it is the width of a pixel by its height: 1 for square pixels\n");
    EXPECT_EQ(
        read_control("SAMPLES 12").said,
        "test.ctl:1:9: error: SAMPLES is 12, but must be a power of two\n"
        "    SAMPLES 12\n"
        "            ^~\n"
        "  2, 4, 8, 16, 32, 64, 128 or 256\n");
    EXPECT_EQ(
        read_control("TOLERANCE -1").said,
        "test.ctl:1:11: error: TOLERANCE is -1, but must be from 0 to 1\n"
        "    TOLERANCE -1\n"
        "              ^~\n"
        "  it is the difference of neighbouring pixels, in any colour, that refines a pixel\n");
}

TEST(ControlFile, WarnsOfWhatDoesNothingAndOfLessThanNoLight) {
    EXPECT_EQ(
        read_control("SAMPLES 8 TOLERANCE 0.2").said,
        "test.ctl:1:1: warning: SAMPLES does nothing without ANTI-ALIAS\n"
        "    SAMPLES 8 TOLERANCE 0.2\n"
        "    ^~~~~~~\n"
        "  give ANTI-ALIAS as well, or --antialias on: edges are smoothed then\n"
        "test.ctl:1:11: warning: TOLERANCE does nothing without ANTI-ALIAS\n"
        "    SAMPLES 8 TOLERANCE 0.2\n"
        "              ^~~~~~~~~\n"
        "  give ANTI-ALIAS as well, or --antialias on: edges are smoothed then\n");
    EXPECT_EQ(read_control("TOLERANCE 0.2 ANTI-ALIAS SAMPLES 8").said, "");
    const Reading reading = read_control("AMBIENT 0 -1 0.5");
    EXPECT_EQ(reading.settings.ambient, (Color{0, -1, 0.5}));
    EXPECT_EQ(
        reading.said,
        "test.ctl:1:9: warning: AMBIENT is 0 -1 0.5, in part below 0\n"
        "    AMBIENT 0 -1 0.5\n"
        "            ^\n"
        "  less than no light darkens what other light makes bright\n");
}

TEST(ControlFile, ReadsTheShapeOfTheHorizon) {
    const auto read = read_control("SKY 0 0 1 PROFILE 4  -90 1  10 2.5  100 -3  190 4  SHADOWS");
    EXPECT_EQ(read.said, "");
    ASSERT_TRUE(read.settings.firmament && read.settings.firmament->profile);
    const auto points = read.settings.firmament->profile->points();
    const std::vector<ProfilePoint> expected = {{10, 2.5}, {100, -3}, {190, 4}, {270, 1}};
    EXPECT_EQ(std::vector(points.begin(), points.end()), expected);
    EXPECT_TRUE(read.settings.shadows);

    const auto made = read_control("PROFILE MOUNTAINS 7 12.5 0.4 SKY 0 0 1");
    EXPECT_EQ(made.said, "");
    ASSERT_TRUE(made.settings.firmament && made.settings.firmament->profile);
    EXPECT_EQ(made.settings.firmament->profile->mountains(), (Mountains{7, 12.5, 0.4}));
}

TEST(ControlFile, SaysWhatIsWrongWithAProfile) {
    EXPECT_EQ(
        read_control("SKY 1 1 1 PROFILE 3 0 1 130 2 240 3").said,
        "test.ctl:1:25: error: from the azimuth 0 to 130 there are more than 120 degrees\n"
        "    SKY 1 1 1 PROFILE 3 0 1 130 2 240 3\n"
        "                            ^~~\n"
        "  give a point between them\n");
    EXPECT_EQ(
        read_control("SKY 1 1 1 PROFILE 3 0 1 120 2 90 3").said,
        "test.ctl:1:31: error: the azimuth 90 does not follow 120\n"
        "    SKY 1 1 1 PROFILE 3 0 1 120 2 90 3\n"
        "                                  ^~\n"
        "  give the points by growing azimuth: 0 is -z, 90 is x, 180 is z, 270 is -x\n");
    EXPECT_EQ(
        read_control("SKY 1 1 1 PROFILE 3 0 1 100 2 200 3").said,
        "test.ctl:1:31: error: from the last azimuth, 200, round to the first, 0, there are more "
        "than 120 degrees\n"
        "    SKY 1 1 1 PROFILE 3 0 1 100 2 200 3\n"
        "                                  ^~~\n"
        "  give a point between them: a profile goes all round\n");
    EXPECT_EQ(
        read_control("SKY 1 1 1 PROFILE 5 0 1 120 2 240 3 300 4 360 5").said,
        "test.ctl:1:43: error: from 0 to 360 the profile goes round more than once\n"
        "    SKY 1 1 1 PROFILE 5 0 1 120 2 240 3 300 4 360 5\n"
        "                                              ^~~\n"
        "  leave out the last points: the profile closes by itself\n");
    EXPECT_EQ(
        read_control("SKY 1 1 1 PROFILE 3 0 85 120 2 240 3").said,
        "test.ctl:1:23: error: the elevation of a point of PROFILE is 85, but must be from -80 to "
        "80\n"
        "    SKY 1 1 1 PROFILE 3 0 85 120 2 240 3\n"
        "                          ^~\n"
        "  it is the angle above the level in degrees, for example 5\n");
    EXPECT_EQ(
        read_control("SKY 1 1 1 PROFILE MOUNTAINS 1 10 2").said,
        "test.ctl:1:34: error: the roughness of MOUNTAINS is 2, but must be from 0 to 1\n"
        "    SKY 1 1 1 PROFILE MOUNTAINS 1 10 2\n"
        "                                     ^\n"
        "  0 makes soft hills, 1 jagged rocks\n");
    EXPECT_EQ(
        read_control("SKY 1 1 1 PROFILE HILLS").said.substr(0, 93),
        "test.ctl:1:19: error: expected MOUNTAINS or the number of points of PROFILE, found "
        "'HILLS'\n  ");
    // The largest number below which doubles tell all whole ones apart.
    EXPECT_EQ(read_control("SKY 1 1 1 PROFILE MOUNTAINS 9007199254740991 10 1").said, "");
    for (const char* seed : {"9007199254740992", "9007199254740993", "1e300"})
        EXPECT_EQ(
            read_control("SKY 1 1 1 PROFILE MOUNTAINS " + std::string(seed) + " 10 1")
                .said.find(
                    "test.ctl:1:29: error: expected the seed of MOUNTAINS, a whole number "
                    "from 0 to 9007199254740991, found '"
                    + std::string(seed) + "'\n"),
            0U);
    EXPECT_EQ(
        read_control("PROFILE MOUNTAINS 1 10 1").said,
        "test.ctl:1:1: warning: PROFILE is ignored without SKY\n"
        "    PROFILE MOUNTAINS 1 10 1\n"
        "    ^~~~~~~\n"
        "  give SKY as well: without it the whole firmament is black\n");
}

TEST(ControlFile, SaysThatAKeywordIsComplete) {
    EXPECT_EQ(
        read_control("SHADOWS 5").said,
        "test.ctl:1:9: error: expected a keyword of control files, found '5'\n"
        "    SHADOWS 5\n"
        "            ^\n"
        "  the SHADOWS before it is complete\n");
}

TEST(ControlFile, NamesTheFileThatIsNotThere) {
    std::vector<Diagnostic> warnings;
    try {
        read_control_file("no/such.ctl", {}, warnings);
        FAIL();
    } catch (const std::system_error& error) {
        EXPECT_NE(std::string(error.what()).find("cannot read 'no/such.ctl'"), std::string::npos);
    }
}

TEST(ControlFile, ReadsAFactorForEachLight) {
    const Reading reading = read_control("RASTER 5 5 LIGHTS 1 .5 0\nSHADOWS");
    EXPECT_EQ(reading.said, "");
    EXPECT_EQ(reading.settings.light_factors, (std::vector<double>{1, 0.5, 0}));
    EXPECT_TRUE(reading.settings.shadows);
    EXPECT_TRUE(read_control("SHADOWS").settings.light_factors.empty());
}

TEST(ControlFile, SaysWhatIsWrongWithFactorsOfLights) {
    EXPECT_EQ(
        read_control("LIGHTS SHADOWS").said,
        "test.ctl:1:8: error: expected a factor of LIGHTS, found 'SHADOWS'\n"
        "    LIGHTS SHADOWS\n"
        "           ^~~~~~~\n");
    EXPECT_EQ(
        read_control("LIGHTS 1 -2").said,
        "test.ctl:1:10: error: a factor of LIGHTS is -2, but must be at least 0\n"
        "    LIGHTS 1 -2\n"
        "             ^~\n"
        "  0 turns a light off, 1 leaves it as it is\n");
}

TEST(ControlFile, ScalesTheLightsOfTheScene) {
    Scene scene;
    scene.lights.resize(2);
    scene.lights[1].intensity = 8;
    PictureSettings settings;
    scale_lights(scene, settings, "test.ctl");
    EXPECT_EQ(scene.lights[1].intensity, 8);
    settings.light_factors = {1, 0.25};
    scale_lights(scene, settings, "test.ctl");
    EXPECT_EQ(scene.lights[0].intensity, 1);
    EXPECT_EQ(scene.lights[1].intensity, 2);

    settings = read_control("SHADOWS\nLIGHTS 1").settings;
    try {
        scale_lights(scene, settings, "test.ctl");
        FAIL() << "one factor for two lights";
    } catch (const InputError& error) {
        EXPECT_EQ(
            to_text(error.diagnostics().front()),
            "test.ctl:2:1: error: LIGHTS gives 1 factor, but the scene has 2 lights\n"
            "  give one factor for each LI, in their order: 1 leaves a light as it is\n");
    }
}

} // namespace
} // namespace vera
