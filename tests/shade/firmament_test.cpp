// SPDX-License-Identifier: Apache-2.0
#include "vera/shade/firmament.h"

#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(Firmament, IsBlackWhereThereIsNone) {
    EXPECT_EQ(firmament_color(std::nullopt, {0, 1, 0}), Color{});
}

TEST(Firmament, GoesFromHorizonToSkyWithTheHeightOfTheDirection) {
    const Firmament firmament = {{0, 0, 1}, {1, 0.5, 0}, {0.25, 0.25, 0.25}};
    EXPECT_EQ(firmament_color(firmament, {0, 1, 0}), (Color{0, 0, 1}));
    EXPECT_EQ(firmament_color(firmament, {1, 0, 0}), (Color{1, 0.5, 0}));
    EXPECT_EQ(firmament_color(firmament, {0, 0.5, 0.8660254037844386}), (Color{0.5, 0.25, 0.5}));
}

TEST(Firmament, IsOneEarthBelow) {
    const Firmament firmament = {{0, 0, 1}, {1, 0.5, 0}, {0.25, 0.5, 0.75}};
    EXPECT_EQ(firmament_color(firmament, {0, -1, 0}), firmament.earth);
    EXPECT_EQ(firmament_color(firmament, {1, -1e-12, 0}), firmament.earth);
}

TEST(Firmament, WithAProfileIsEarthBelowItAndAboveItTheSkyThatItWasWithout) {
    const Firmament plain = {{0, 0, 1}, {1, 0.5, 0}, {0.25, 0.5, 0.75}};
    Firmament shaped = plain;
    shaped.profile = HorizonProfile({{0, 45}, {120, 0}, {240, -45}});
    const Vec3 above_peak = normalized({0, 1.1, -1});
    EXPECT_EQ(firmament_color(shaped, above_peak), firmament_color(plain, above_peak));
    EXPECT_EQ(firmament_color(shaped, normalized({0, 0.9, -1})), plain.earth);
    // In a valley that goes down below the level the sky is the horizon's, without a step.
    const Vec3 in_valley = normalized({-0.86, -0.5, 0.5});
    EXPECT_EQ(firmament_color(shaped, in_valley), plain.horizon);
    EXPECT_EQ(firmament_color(shaped, normalized({-0.86, -1.1, 0.5})), plain.earth);
}

} // namespace
} // namespace vera
