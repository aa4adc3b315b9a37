// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/render/exposure.h"

#include <vector>

#include "test_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

ExposureSample grey(double scaled, double fixed) {
    return {{scaled, scaled, scaled}, {fixed, fixed, fixed}};
}

TEST(Exposure, BrightnessIsTheNearestRankQuantile) {
    std::vector<ExposureSample> samples;
    for (int i = 1; i <= 20; ++i)
        samples.push_back(grey(i, 0));
    EXPECT_EQ(brightness(samples, 1), 19) << "19 of 20 are 95 %";
    EXPECT_EQ(brightness(samples, 0.5), 9.5);
    samples.push_back(grey(21, 0));
    EXPECT_EQ(brightness(samples, 1), 20) << "19 of 21 are not 95 %";
    EXPECT_EQ(brightness({}, 1), 0);
}

TEST(Exposure, TheValueOfARayIsItsLargestColour) {
    const std::vector<ExposureSample> samples = {{{0.5, 0.25, 0}, {0, 0.5, 0.25}}};
    EXPECT_EQ(brightness(samples, 1), 0.75);
    EXPECT_EQ(brightness(samples, 4), 2);
    EXPECT_EQ(exposure_factor(samples, 1), 2) << "where red and green both reach 1";
}

TEST(Exposure, TheFactorMakesTheQuantileEqualTheTarget) {
    std::vector<ExposureSample> samples;
    for (int i = 1; i <= 100; ++i)
        samples.push_back(grey(i / 64.0, (i % 7) / 32.0));
    for (const double target : {0.25, 0.5, 1.0}) {
        const auto factor = exposure_factor(samples, target);
        ASSERT_TRUE(factor);
        EXPECT_NEAR(brightness(samples, *factor), target, 1e-15);
    }
}

TEST(Exposure, NoFactorReachesWhatTheFixedPartExceeds) {
    EXPECT_FALSE(exposure_factor(std::vector{grey(1, 0.75)}, 0.5));
    EXPECT_FALSE(exposure_factor(std::vector{grey(1, 0.5)}, 0.5)) << "the factor 0 is none";
}

TEST(Exposure, NoFactorReachesWhatTheLightCannotChange) {
    EXPECT_FALSE(exposure_factor(std::vector{grey(0, 0.25)}, 0.5));
    EXPECT_FALSE(exposure_factor({}, 0.5));
}

TEST(Exposure, TheFactorIsOneWhereItFitsAlready) {
    EXPECT_EQ(exposure_factor(std::vector{grey(0, 0.5)}, 0.5), 1);
    EXPECT_EQ(exposure_factor(std::vector{grey(0.25, 0.25)}, 0.5), 1);
}

TEST(Exposure, TheFactorIsFoundWhereTheTargetIsMetOverARange) {
    // The quantile of two is the larger one: 1/2 up to s = 2, of the first alone.
    EXPECT_EQ(exposure_factor(std::vector{grey(0, 0.5), grey(0.25, 0)}, 0.5), 1);
    EXPECT_EQ(exposure_factor(std::vector{grey(0, 0.5), grey(2, 0)}, 0.5), 0.25);
}

/// A floor that fills the picture, lit by AMBIENT and itself luminous.
struct LitFloor : SceneMaker {
    explicit LitFloor(double luminosity) {
        Material floor = luminous({luminosity, 0, 0});
        floor.arf = {0.5, 0.25, 0};
        material(floor);
        polygon({{-9, -9, -1}, {9, -9, -1}, {9, 9, -1}, {-9, 9, -1}});
        look_down_in_parallel(1);
        light({0, 0, 1e9}, 1e18, {0, 0, 1});
        finish();
    }

    Exposure exposed(double target) {
        const auto index = make_brute_force(scene);
        PictureSettings settings = plain_settings(8, 8);
        settings.ambient = {0.5, 0.5, 0.5};
        settings.shadows = false;
        TracedScene traced = traced_scene(scene, *index, settings);
        const Exposure exposure = expose(traced, *scene.camera, target, statistics);
        illumination = traced.illumination;
        return exposure;
    }

    Illumination illumination;
    RenderStatistics statistics;
};

TEST(Exposure, OfAPictureIsMeasuredOnly) {
    LitFloor floor(0.25);
    const Exposure exposure = floor.exposed(0);
    EXPECT_EQ(exposure.rays, 64U * 64);
    EXPECT_DOUBLE_EQ(exposure.brightness, 0.5);
    EXPECT_EQ(exposure.part_too_bright, 0);
    EXPECT_EQ(exposure.factor, 1);
    ASSERT_TRUE(exposure.full_factor);
    EXPECT_DOUBLE_EQ(*exposure.full_factor, 3);
    EXPECT_EQ(floor.illumination.ambient, (Color{0.5, 0.5, 0.5}));
}

TEST(Exposure, OfAPictureScalesLightSourcesAndAmbientAlike) {
    LitFloor floor(0.25);
    const Exposure exposure = floor.exposed(0.75);
    EXPECT_DOUBLE_EQ(exposure.factor, 2);
    EXPECT_DOUBLE_EQ(floor.illumination.ambient.r, 1);
    EXPECT_DOUBLE_EQ(floor.illumination.lights[0].intensity, 2e18);
}

TEST(Exposure, OfAPictureStaysWhereNoFactorHelps) {
    LitFloor floor(0.75);
    const Exposure exposure = floor.exposed(0.5);
    EXPECT_FALSE(exposure.reachable);
    EXPECT_EQ(exposure.factor, 1);
    EXPECT_EQ(floor.illumination.ambient, (Color{0.5, 0.5, 0.5}));
}

} // namespace
} // namespace vera
