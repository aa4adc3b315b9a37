// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/sloped_ray.h"

#include <random>
#include <stdexcept>
#include <string>

#include "theory/rectangles.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::Rectangles;
using testing::SlopedRays;

/// The same ray from a point and a direction.
WholeRay whole_ray(const SlopedRay& ray) {
    return {
        {static_cast<std::int32_t>(value_at(x_point(ray), ray.first_z)),
         static_cast<std::int32_t>(value_at(y_point(ray), ray.first_z)),
         ray.first_z},
        {ray.slope_x, ray.slope_y, 1}};
}

TEST(SlopedRay, MeetsWhatTheSameRayMeetsFromItsOrigin) {
    std::mt19937_64 random(1988);
    int met = 0;
    int missed = 0;
    for (int round = 0; round < 100; ++round)
        for (const testing::RayFamily& family : testing::ray_families()) {
            const Rectangles rectangles = round % 3 == 0
                ? testing::repeated_rectangles(20, random)
                : testing::rectangles_within(20, 5, 6, random);
            const SlopedRays rays = family.rays(20, 5, 2, random);
            const FirstRectangles first = brute_force_first_rectangles(rectangles, rays);
            ASSERT_EQ(first.size(), rays.size());
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_EQ(first[i], brute_force_first_rectangle(rectangles, whole_ray(rays[i])))
                    << family.name << ", ray " << i;
                ++(first[i] ? met : missed);
            }
        }
    EXPECT_GT(met, 1000);
    EXPECT_GT(missed, 1000);
}

TEST(SlopedRay, IsRefusedWhereItsNumbersAreTooLarge) {
    try {
        brute_force_first_rectangles({}, SlopedRays{{}, {0, 0, -1073741825, 0, 0}});
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(
            error.what(),
            "ray 1 has the number -1073741825, and the largest magnitude is 1073741824: scale "
            "everything down");
    }
}

} // namespace
} // namespace vera
