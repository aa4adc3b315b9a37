// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/exact_triangles.h"
#include "vera/scene/triangle_crossing.h"

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <random>

#include <gtest/gtest.h>

namespace vera::detail {
namespace {

/// Numbers of which few are different, so that rays pass through corners and along edges and
/// planes.
double few(std::mt19937_64& random) {
    constexpr std::array<double, 9> numbers = {0, 0, 1, -1, 0.5, -2, 1e-300, 0.1, 3e7};
    return numbers[random() % numbers.size()];
}

Vec3 few_point(std::mt19937_64& random) {
    return {few(random), few(random), few(random)};
}

Ray few_ray(std::mt19937_64& random) {
    constexpr double forever = std::numeric_limits<double>::infinity();
    Ray ray;
    ray.origin = few_point(random);
    ray.direction = few_point(random);
    ray.t_min = std::array{0.0, 0.0, 0.5, -forever}[random() % 4];
    ray.t_max = random() % 2 == 0 ? forever : 1;
    ray.origin_error = random() % 4 == 0 ? 1e-9 : 0;
    return ray;
}

TEST(ExactTriangles, AreCrossedLikeOneByOneToTheBit) {
    std::mt19937_64 random(3);
    const auto frame = std::make_unique<Frame>();
    std::size_t crossings = 0;
    for (int round = 0; round < 20'000; ++round) {
        std::array<std::array<Vec3, 3>, packet_size> triangles;
        TriangleRows rows;
        for (std::size_t lane = 0; lane < packet_size; ++lane) {
            const Ray ray = few_ray(random);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                frame->rays.origin[axis][lane] = ray.origin[axis];
                frame->rays.direction[axis][lane] = ray.direction[axis];
            }
            frame->rays.t_min[lane] = ray.t_min;
            frame->rays.t_max[lane] = ray.t_max;
            frame->rays.origin_error[lane] = ray.origin_error;
            triangles[lane] = {few_point(random), few_point(random), few_point(random)};
            for (std::size_t corner = 0; corner < 3; ++corner)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    rows[corner][axis][lane] = triangles[lane][corner][axis];
        }
        const auto lanes = static_cast<LaneMask>(random());
        RayRows::Row t;
        prepare_rays(*frame);
        const LaneMask met = cross_triangles(*frame, lanes, rows, t);
        EXPECT_EQ(met & ~lanes, 0U);
        for (std::size_t lane = 0; lane < packet_size; ++lane) {
            if ((lanes >> lane & 1U) == 0)
                continue;
            const auto& [a, b, c] = triangles[lane];
            const std::optional<double> expected =
                triangle_crossing(PreparedRay(frame->rays.ray(lane)), a, b, c);
            ASSERT_EQ((met >> lane & 1U) != 0, expected.has_value());
            if (!expected)
                continue;
            ++crossings;
            ASSERT_EQ(
                std::bit_cast<std::uint64_t>(t[lane]), std::bit_cast<std::uint64_t>(*expected));
        }
    }
    EXPECT_GT(crossings, 1000U);
}

} // namespace
} // namespace vera::detail
