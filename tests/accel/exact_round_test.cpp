// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/exact_round.h"
#include "vera/scene/rotational_crossing.h"
#include "vera/scene/sphere_crossing.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vera::detail {
namespace {

/// Numbers of which few are different, so that rays start on surfaces, touch them, run along axes
/// and through ends; and one that is like no other.
double few(std::mt19937_64& random) {
    constexpr std::array<double, 9> numbers = {0, 0, 1, -1, 0.5, -2, 1e-300, 0.1, 3e7};
    const std::size_t which = random() % (numbers.size() + 1);
    return which < numbers.size() ? numbers[which]
                                  : std::uniform_real_distribution(-2.0, 2.0)(random);
}

Vec3 few_point(std::mt19937_64& random) {
    return {few(random), few(random), few(random)};
}

void set_few_rays(std::mt19937_64& random, Frame& frame) {
    constexpr double forever = std::numeric_limits<double>::infinity();
    for (std::size_t lane = 0; lane < packet_size; ++lane) {
        const Vec3 origin = few_point(random);
        const Vec3 direction = few_point(random);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            frame.rays.origin[axis][lane] = origin[axis];
            frame.rays.direction[axis][lane] = direction[axis];
        }
        frame.rays.t_min[lane] = std::array{0.0, 0.0, 0.5, -forever}[random() % 4];
        frame.rays.t_max[lane] = random() % 2 == 0 ? forever : 1;
        frame.rays.origin_error[lane] = random() % 4 == 0 ? 1e-9 : 0;
    }
}

std::vector<std::uint64_t> found(const RoundCrossings& crossings, std::size_t lane) {
    std::vector<std::uint64_t> ts;
    for (std::size_t i = 0; i < 2; ++i)
        if ((crossings.met[i] >> lane & 1U) != 0)
            ts.push_back(std::bit_cast<std::uint64_t>(crossings.t[i][lane]));
    std::sort(ts.begin(), ts.end());
    return ts;
}

/// What one_by_one(ray, starts, sink) says of each lane is what was found for it. Counts those that
/// were met.
template <typename OneByOne>
std::size_t expect_the_same(
    const Frame& frame,
    LaneMask lanes,
    LaneMask starting,
    const RoundCrossings& crossings,
    const OneByOne& one_by_one) {
    EXPECT_EQ((crossings.undecided | crossings.met[0] | crossings.met[1]) & ~lanes, 0U);
    EXPECT_EQ(crossings.undecided & (crossings.met[0] | crossings.met[1]), 0U);
    std::size_t met = 0;
    for (std::size_t lane = 0; lane < packet_size; ++lane) {
        if (((lanes & ~crossings.undecided) >> lane & 1U) == 0)
            continue;
        std::vector<std::uint64_t> expected;
        one_by_one(
            PreparedRay(frame.rays.ray(lane)), lane, (starting >> lane & 1U) != 0, [&](double t) {
                expected.push_back(std::bit_cast<std::uint64_t>(t));
            });
        std::sort(expected.begin(), expected.end());
        EXPECT_EQ(found(crossings, lane), expected);
        met += expected.empty() ? 0 : 1;
    }
    return met;
}

TEST(ExactRound, SpheresAreCrossedLikeOneByOneToTheBit) {
    std::mt19937_64 random(5);
    const auto frame = std::make_unique<Frame>();
    std::size_t met = 0;
    for (int round = 0; round < 10'000 && !testing::Test::HasFailure(); ++round) {
        set_few_rays(random, *frame);
        std::array<Sphere, packet_size> spheres;
        SphereRows rows;
        for (std::size_t lane = 0; lane < packet_size; ++lane) {
            Sphere& sphere = spheres[lane];
            sphere = {few_point(random), std::array{1.0, 0.5, 2.0, 1e-200, 3e7}[random() % 5]};
            for (std::size_t axis = 0; axis < 3; ++axis)
                rows.center[axis][lane] = sphere.center[axis];
            rows.radius[lane] = sphere.radius;
        }
        const auto lanes = static_cast<LaneMask>(random());
        const auto starting = static_cast<LaneMask>(random() & random());
        RoundCrossings crossings;
        cross_spheres(*frame, lanes, starting, rows, crossings);
        EXPECT_EQ(crossings.undecided, 0U);
        met += expect_the_same(
            *frame,
            lanes,
            starting,
            crossings,
            [&](const PreparedRay& ray, std::size_t lane, bool starts, const auto& sink) {
                for_each_sphere_crossing(ray, spheres[lane], starts, sink);
            });
    }
    EXPECT_GT(met, 10'000U);
}

TEST(ExactRound, MantlesAreCrossedLikeOneByOneToTheBit) {
    std::mt19937_64 random(7);
    const auto frame = std::make_unique<Frame>();
    std::size_t met = 0;
    std::size_t undecided = 0;
    for (int round = 0; round < 10'000 && !testing::Test::HasFailure(); ++round) {
        set_few_rays(random, *frame);
        std::array<RotationalShape, packet_size> shapes;
        MantleRows rows;
        for (std::size_t lane = 0; lane < packet_size; ++lane) {
            RotationalShape& shape = shapes[lane];
            shape.base = few_point(random);
            const Vec3 axis = normalized(few_point(random));
            shape.axis = axis == Vec3{} ? Vec3{0, 0, 1} : axis;
            shape.start = {std::array{0.0, 0.5, 1.0}[random() % 3], few(random)};
            const double length = std::array{1.0, -0.5, 2.0}[random() % 3];
            shape.contour.push_back(
                {.end = {std::array{0.0, 0.5, 1.0, 1.5}[random() % 4], shape.start.h + length}});
            for (std::size_t i = 0; i < 3; ++i) {
                rows.base[i][lane] = shape.base[i];
                rows.axis[i][lane] = shape.axis[i];
            }
            rows.start_r[lane] = shape.start.r;
            rows.start_h[lane] = shape.start.h;
            rows.end_r[lane] = shape.contour[0].end.r;
            rows.end_h[lane] = shape.contour[0].end.h;
        }
        const auto lanes = static_cast<LaneMask>(random());
        const auto starting = static_cast<LaneMask>(random() & random() & random());
        RoundCrossings crossings;
        cross_mantles(*frame, lanes, starting, rows, crossings);
        EXPECT_EQ(lanes & starting & ~crossings.undecided, 0U);
        undecided += static_cast<std::size_t>(std::popcount(crossings.undecided));
        met += expect_the_same(
            *frame,
            lanes,
            0,
            crossings,
            [&](const PreparedRay& ray, std::size_t lane, bool, const auto& sink) {
                for_each_rotational_crossing(
                    ray, shapes[lane], no_piece, [&](double t, std::uint32_t) { sink(t); });
            });
    }
    EXPECT_GT(met, 5'000U);
    EXPECT_LT(undecided, std::size_t{10'000} * packet_size / 4);
}

} // namespace
} // namespace vera::detail
