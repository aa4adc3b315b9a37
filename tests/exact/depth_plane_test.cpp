// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/depth_plane.h"

#include <array>
#include <cmath>
#include <random>

#include "exact/few_points.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

ScreenVertex few_vertex(std::mt19937_64& random) {
    constexpr std::array<std::int64_t, 6> depths = {
        0, 1, 12345, depth_size / 2, depth_size - 1, depth_size};
    const ScreenPoint point = testing::few_point(random);
    return {point, depths[random() % depths.size()]};
}

std::array<ScreenVertex, 3> few_corners(std::mt19937_64& random) {
    while (true) {
        std::array<ScreenVertex, 3> corners = {
            few_vertex(random), few_vertex(random), few_vertex(random)};
        const std::int64_t area = orientation(corners[0].point, corners[1].point, corners[2].point);
        if (area < 0)
            std::swap(corners[0], corners[1]);
        if (area != 0)
            return corners;
    }
}

TEST(DepthPlane, PassesThroughItsCorners) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 20'000; ++i) {
        const auto corners = few_corners(random);
        const DepthPlane plane = depth_plane(corners);
        for (const ScreenVertex& corner : corners) {
            const ScreenStep way = step(plane.at, corner.point);
            const Int128 rise = Int128{plane.along_x} * way.x + Int128{plane.along_y} * way.y;
            EXPECT_TRUE(rise == Int128{plane.area} * (corner.nearness - plane.nearness));
            // Far larger terms may cancel.
            const double size =
                (std::abs(static_cast<double>(plane.along_x) * static_cast<double>(way.x))
                 + std::abs(static_cast<double>(plane.along_y) * static_cast<double>(way.y)))
                / static_cast<double>(plane.area);
            EXPECT_NEAR(
                plane.value(corner.point.x, corner.point.y),
                static_cast<double>(corner.nearness),
                1e-6 + 0x1p-48 * size);
        }
    }
}

} // namespace
} // namespace vera
