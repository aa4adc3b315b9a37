// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/horizon_profile.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// How far above the profile the direction is, as the difference of two tangents: by angles, and
/// the formula of a great circle between two places of known heights.
double height_above(const HorizonProfile& profile, Vec3 direction) {
    const auto points = profile.points();
    const double azimuth = std::atan2(direction.x, -direction.z) / degree;
    std::size_t i = points.size() - 1;
    const double turned = azimuth < 0 ? azimuth + 360 : azimuth;
    for (std::size_t k = 0; k < points.size(); ++k)
        if (points[k].azimuth_degrees <= turned)
            i = k;
    const ProfilePoint a = points[i];
    const ProfilePoint b = points[(i + 1) % points.size()];
    const auto sine = [](double from, double to) { return std::sin((to - from) * degree); };
    const double tangent =
        (std::tan(a.elevation_degrees * degree) * sine(turned, b.azimuth_degrees)
         + std::tan(b.elevation_degrees * degree) * sine(a.azimuth_degrees, turned))
        / sine(a.azimuth_degrees, b.azimuth_degrees);
    return direction.y / std::hypot(direction.x, direction.z) - tangent;
}

std::size_t side_by_plain_search(const HorizonProfile& profile, Vec3 direction) {
    std::size_t side = profile.directions().size() - 1;
    for (std::size_t i = 0; i < profile.directions().size(); ++i)
        if (HorizonProfile::turn_of(profile.directions()[i]) <= HorizonProfile::turn_of(direction))
            side = i;
    return side;
}

HorizonProfile random_profile(std::mt19937& random) {
    const double elevations[] = {-20, 0, 0, 5, 45, 80};
    const double gaps[] = {15, 30, 45, 90, 120};
    std::vector<ProfilePoint> points;
    const double first = 15.0 * static_cast<double>(random() % 24) - 180;
    for (double azimuth = first; azimuth < first + 360;) {
        points.push_back({azimuth, elevations[random() % 6]});
        azimuth += std::min(gaps[random() % 5], std::max(15.0, first + 345 - azimuth));
    }
    return HorizonProfile(points);
}

Vec3 random_direction(std::mt19937& random) {
    const double values[] = {-2, -1, -0.5, -0.0, 0, 0.1, 0.5, 1, 2};
    const auto value = [&] { return values[random() % 9]; };
    return {value(), value(), value()};
}

TEST(HorizonProfile, AgreesWithHeightsFoundByAngles) {
    std::mt19937 random(1988);
    std::size_t compared = 0;
    for (int round = 0; round < 300; ++round) {
        const HorizonProfile profile = random_profile(random);
        for (int i = 0; i < 100; ++i) {
            const Vec3 direction = random_direction(random);
            if (direction.x == 0 && direction.z == 0)
                continue;
            const double above = height_above(profile, direction);
            if (std::abs(above) < 1e-9)
                continue;
            ++compared;
            ASSERT_EQ(profile.hides(direction), above < 0) << "round " << round << ", " << i;
        }
    }
    EXPECT_GT(compared, 20000U);
}

TEST(HorizonProfile, FindsTheSideThatAPlainSearchFinds) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(-1, 1);
    const HorizonProfile mountains(Mountains{3, 20, 0.9});
    for (int round = 0; round < 300; ++round) {
        const HorizonProfile profile = random_profile(random);
        for (int i = 0; i < 100; ++i) {
            const Vec3 direction = random_direction(random);
            ASSERT_EQ(profile.side_of(direction), side_by_plain_search(profile, direction));
        }
        for (const Vec3 direction : profile.directions())
            ASSERT_EQ(profile.side_of(direction), side_by_plain_search(profile, direction));
        const Vec3 direction = {any(random), any(random), any(random)};
        ASSERT_EQ(mountains.side_of(direction), side_by_plain_search(mountains, direction));
    }
}

TEST(HorizonProfile, AtLevelHidesWhatIsBelowTheLevelAndNothingElse) {
    const HorizonProfile level({{0, 0}, {90, 0}, {200, 0}, {300, 0}});
    std::mt19937 random(7);
    for (int i = 0; i < 10000; ++i) {
        const Vec3 direction = random_direction(random);
        ASSERT_EQ(level.hides(direction), direction.y < 0);
    }
    EXPECT_FALSE(level.hides({1, 0x1p-1000, 0}));
    EXPECT_TRUE(level.hides({1, -0x1p-1000, 0}));
}

TEST(HorizonProfile, NeverHidesWhatIsStraightAbove) {
    std::mt19937 random(9);
    for (int i = 0; i < 200; ++i) {
        const HorizonProfile profile = random_profile(random);
        EXPECT_FALSE(profile.hides({0, 1, 0}));
        EXPECT_TRUE(profile.hides({0, -1, 0}));
        EXPECT_FALSE(profile.hides({-1e-30, 1, 1e-30}));
    }
}

TEST(HorizonProfile, HasItsPointsInTheOrderOfTheCompass) {
    const HorizonProfile profile({{-90, 1}, {10, 2}, {100, 3}, {190, 4}});
    const std::vector<ProfilePoint> expected = {{10, 2}, {100, 3}, {190, 4}, {270, 1}};
    EXPECT_EQ(std::vector(profile.points().begin(), profile.points().end()), expected);
    EXPECT_TRUE(profile.hides({0, 0.01, -1}));  // north, between 270 and 10
    EXPECT_FALSE(profile.hides({0, 0.04, -1})); // where the height is 2 degrees, nearly
}

TEST(HorizonProfile, OfMountainsReachesItsHeightAndTheLevel) {
    for (const double roughness : {0.0, 0.5, 1.0}) {
        const HorizonProfile profile(Mountains{42, 12.5, roughness});
        double lowest = 90;
        double highest = -90;
        for (const ProfilePoint& point : profile.points()) {
            lowest = std::min(lowest, point.elevation_degrees);
            highest = std::max(highest, point.elevation_degrees);
        }
        EXPECT_EQ(lowest, 0);
        EXPECT_DOUBLE_EQ(highest, 12.5);
    }
}

/// How long the way along the profile is, up and down: rough ones have the longer way.
double way_of(const Mountains& mountains) {
    const HorizonProfile profile(mountains);
    const auto points = profile.points();
    double way = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
        way += std::abs(points[i].elevation_degrees - points[i - 1].elevation_degrees);
    return way;
}

TEST(HorizonProfile, OfMountainsIsAnotherForEachSeedAndRougherForMoreRoughness) {
    const HorizonProfile one(Mountains{1, 10, 0.5});
    const HorizonProfile again(Mountains{1, 10, 0.5});
    const HorizonProfile other(Mountains{2, 10, 0.5});
    EXPECT_TRUE(std::ranges::equal(one.points(), again.points()));
    EXPECT_FALSE(std::ranges::equal(one.points(), other.points()));
    EXPECT_GT(way_of({1, 10, 1}), 2 * way_of({1, 10, 0}));
}

} // namespace
} // namespace vera
