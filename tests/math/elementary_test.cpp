// SPDX-License-Identifier: Apache-2.0
#include "vera/math/elementary.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(SinDegrees, IsExactAtQuarterTurns) {
    EXPECT_EQ(sin_degrees(0), 0);
    EXPECT_EQ(sin_degrees(90), 1);
    EXPECT_EQ(sin_degrees(180), 0);
    EXPECT_EQ(sin_degrees(-90), -1);
    EXPECT_EQ(sin_degrees(360e6), 0);
    EXPECT_EQ(cos_degrees(0), 1);
    EXPECT_EQ(cos_degrees(90), 0);
    EXPECT_EQ(cos_degrees(-180), -1);
    EXPECT_EQ(cos_degrees(270), 0);
}

TEST(SinDegrees, AgreesWithTheMathematicsLibraryToRounding) {
    for (int i = -4000; i <= 4000; ++i) {
        const double angle = 0.37 * i;
        const double radians = std::fmod(angle, 360.0) * (std::numbers::pi / 180);
        ASSERT_NEAR(sin_degrees(angle), std::sin(radians), 1.5e-15) << angle;
        ASSERT_NEAR(cos_degrees(angle), std::cos(radians), 1.5e-15) << angle;
    }
}

TEST(Power, AgreesWithTheMathematicsLibraryToRounding) {
    for (const double base : {1e-9, 0.04, 0.5, 0.9999, 1.0, 1.5, 7.0, 1e6})
        for (const double exponent : {-3.0, -0.5, 0.0, 0.4166, 1.0, 2.4, 4.0}) {
            const double expected = std::pow(base, exponent);
            ASSERT_NEAR(power(base, exponent), expected, 1e-13 * expected)
                << base << '^' << exponent;
        }
    EXPECT_EQ(power(0, 2.4), 0);
    EXPECT_EQ(power(1, 1e6), 1);
}

TEST(Srgb, DecodesKnownValuesAndEncodesThemBack) {
    EXPECT_EQ(srgb_decoded(0), 0);
    EXPECT_NEAR(srgb_decoded(1), 1, 1e-15);
    EXPECT_NEAR(srgb_decoded(0.5), 0.21404114048223255, 1e-15);
    for (int i = -512; i <= 1024; ++i)
        ASSERT_NEAR(srgb_encoded(srgb_decoded(i / 256.0)), i / 256.0, 1e-12);
}

} // namespace
} // namespace vera
