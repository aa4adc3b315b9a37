// SPDX-License-Identifier: Apache-2.0
#include "vera/solids/sphere_crossing.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace vera {
namespace {

/// The least of a convex function over 0 to 1, by thirds.
template <typename Function>
double least(const Function& value) {
    double begin = 0;
    double end = 1;
    for (int i = 0; i < 45; ++i) {
        const double first = begin + (end - begin) / 3;
        const double second = end - (end - begin) / 3;
        (value(first) <= value(second) ? end : begin) =
            value(first) <= value(second) ? second : first;
    }
    return value((begin + end) / 2);
}

/// Plainly: the least over all points of the triangle.
double distance(Vec3 point, const TriangleCorners& t) {
    return least([&](double s) {
        const Vec3 left = t[0] + s * (t[1] - t[0]);
        const Vec3 right = t[0] + s * (t[2] - t[0]);
        return least([&](double r) { return length(left + r * (right - left) - point); });
    });
}

TEST(SphereCrossing, OfTrianglesAgreesWithTheLeastAndTheLargestDistance) {
    std::mt19937 random(1907);
    const auto number = [&] { return static_cast<double>(random() % 5) - 2; };
    const auto point = [&] {
        const double x = number();
        const double y = number();
        const double z = number();
        return Vec3{x, y, z};
    };
    int crossing = 0;
    int touching = 0;
    for (int round = 0; round < 3000; ++round) {
        const TriangleCorners triangle = {point(), point(), point()};
        const Sphere sphere = {point(), static_cast<double>(1 + random() % 3)};
        double farthest = 0;
        for (const Vec3 corner : triangle)
            farthest = std::max(farthest, length(corner - sphere.center));
        const double nearest = distance(sphere.center, triangle);
        const bool is_touched = std::abs(nearest - sphere.radius) < 1e-7;
        touching += is_touched ? 1 : 0;
        const bool expected =
            !is_touched && nearest < sphere.radius && farthest > (1 + 1e-7) * sphere.radius;
        ASSERT_EQ(is_crossing(sphere, triangle), expected) << "round " << round;
        crossing += expected ? 1 : 0;
    }
    EXPECT_GT(crossing, 100);
    EXPECT_GT(touching, 50);
}

TEST(SphereCrossing, OfSpheresIsBetweenTouchingOutsideAndTouchingInside) {
    const Sphere two = {{0, 0, 0}, 2};
    const auto crosses = [&](double x) { return is_crossing(two, Sphere{{x, 0, 0}, 1}); };
    EXPECT_FALSE(crosses(4));
    EXPECT_FALSE(crosses(3));
    EXPECT_FALSE(crosses(3 - 1e-6)); // nearly touching
    EXPECT_TRUE(crosses(3 - 1e-5));
    EXPECT_TRUE(crosses(2));
    EXPECT_TRUE(crosses(1 + 1e-5));
    EXPECT_FALSE(crosses(1 + 1e-6));
    EXPECT_FALSE(crosses(1));
    EXPECT_FALSE(crosses(0));
    EXPECT_FALSE(is_crossing(two, two));
}

TEST(SphereCrossing, LeavesAloneWhatRestsOnASlope) {
    // A ball on a plane of slope 3 in 4, its centre to six digits.
    const TriangleCorners slope = {Vec3{-40, -30, -50}, Vec3{40, 30, -50}, Vec3{0, 0, 90}};
    EXPECT_FALSE(is_crossing(Sphere{{-0.6, 0.8, 0}, 1}, slope));
    EXPECT_FALSE(is_crossing(Sphere{{-0.5999995, 0.8, 0}, 1}, slope));
    EXPECT_TRUE(is_crossing(Sphere{{-0.59, 0.8, 0}, 1}, slope));
}

} // namespace
} // namespace vera
