// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/depth_plane.h"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace vera {
namespace {

ScreenVertex few(std::mt19937_64& random) {
    constexpr std::array<std::int32_t, 6> numbers = {
        0, 1, 100, screen_size / 2, screen_size - 1, screen_size};
    constexpr std::array<std::int64_t, 6> depths = {
        0, 1, 12345, depth_size / 2, depth_size - 1, depth_size};
    return {
        {numbers[random() % numbers.size()], numbers[random() % numbers.size()]},
        depths[random() % depths.size()]};
}

std::array<ScreenVertex, 3> few_corners(std::mt19937_64& random) {
    while (true) {
        std::array<ScreenVertex, 3> corners = {few(random), few(random), few(random)};
        const std::int64_t area = orientation(corners[0].point, corners[1].point, corners[2].point);
        if (area < 0)
            std::swap(corners[0], corners[1]);
        if (area != 0)
            return corners;
    }
}

TEST(DepthPlane, PassesThroughItsCornersWhateverTheirOrder) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 20'000; ++i) {
        const auto corners = few_corners(random);
        const DepthPlane plane = depth_plane(corners);
        const DepthPlane turned = depth_plane({corners[1], corners[2], corners[0]});
        for (const ScreenVertex& corner : corners) {
            const DepthPlane level = {{0, 0}, corner.nearness, 0, 0, 1};
            EXPECT_TRUE(nearness_difference(plane, level, corner.point) == 0);
            EXPECT_TRUE(nearness_difference(plane, turned, corner.point) == 0);
        }
    }
}

/// The planes' difference at a place, by long doubles where these surely tell it.
TEST(PlaneComparison, TellsWhoIsNearerAtPlacesAndBesideThem) {
    std::mt19937_64 random(2);
    int decided = 0;
    for (int i = 0; i < 50'000; ++i) {
        const DepthPlane a = depth_plane(few_corners(random));
        const DepthPlane b = depth_plane(few_corners(random));
        const ScreenPoint begin = few(random).point;
        const ScreenPoint end = few(random).point;
        if (begin == end)
            continue;
        const PlaneComparison compared(a, b, begin, end);
        const SegmentPlace place = {static_cast<std::int64_t>(random() % 8), 7};
        const auto value = [&](const DepthPlane& plane) {
            const long double s = static_cast<long double>(place.numerator)
                / static_cast<long double>(place.denominator);
            const long double x = begin.x + s * (end.x - begin.x) - plane.at.x;
            const long double y = begin.y + s * (end.y - begin.y) - plane.at.y;
            return static_cast<long double>(plane.nearness)
                + (static_cast<long double>(plane.along_x) * x
                   + static_cast<long double>(plane.along_y) * y)
                / static_cast<long double>(plane.area);
        };
        const long double difference = value(a) - value(b);
        const long double error =
            0x1p-56L * (std::abs(value(a)) + std::abs(value(b)) + std::ldexp(1.0L, 80));
        if (std::abs(difference) <= error)
            continue;
        ++decided;
        EXPECT_EQ(compared.at(place), difference > 0 ? 1 : -1);
        EXPECT_TRUE(compared.keeps_order(place, place));
        EXPECT_EQ(compared.beside(place, place, true), difference > 0 ? 1 : -1);
    }
    EXPECT_GT(decided, 10'000);
}

TEST(PlaneComparison, LooksBesideTheSegmentWherePlanesMeetInIt) {
    // Two faces that meet in the segment like a roof; on its left, upward, a falls off more.
    const ScreenPoint begin = {0, 100};
    const ScreenPoint end = {100, 100};
    const DepthPlane a = depth_plane({{{{0, 100}, 50}, {{100, 100}, 50}, {{0, 200}, 10}}});
    const DepthPlane b = depth_plane({{{{0, 100}, 50}, {{100, 100}, 50}, {{0, 200}, 40}}});
    const PlaneComparison compared(a, b, begin, end);
    EXPECT_EQ(compared.at({1, 2}), 0);
    EXPECT_EQ(compared.beside({0, 1}, {1, 1}, true), -1);
    EXPECT_EQ(compared.beside({0, 1}, {1, 1}, false), 1);
    EXPECT_EQ(PlaneComparison(a, a, begin, end).beside({0, 1}, {1, 1}, true), 0);
}

TEST(PlaneComparison, TellsWherePlanesPassEachOther) {
    const DepthPlane level = {{0, 0}, 50, 0, 0, 1};
    const DepthPlane rising = depth_plane({{{{0, 0}, 0}, {{100, 0}, 100}, {{0, 100}, 0}}});
    const PlaneComparison compared(level, rising, {0, 0}, {100, 0});
    EXPECT_FALSE(compared.keeps_order({0, 1}, {1, 1}));
    EXPECT_TRUE(compared.keeps_order({0, 1}, {1, 2}));
    EXPECT_TRUE(compared.keeps_order({1, 2}, {1, 1}));
    EXPECT_EQ(compared.at({1, 2}), 0);
    EXPECT_EQ(compared.beside({0, 1}, {1, 2}, true), 1);
    EXPECT_EQ(compared.beside({1, 2}, {1, 1}, true), -1);
}

} // namespace
} // namespace vera
