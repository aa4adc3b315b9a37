// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/big_integer.h"
#include "vera/exact/orientation.h"
#include "vera/exact/wide_integer.h"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(BigInteger, ComputesAsWholeNumbersDo) {
    std::mt19937_64 random(3);
    const std::int64_t values[] = {
        0, 1, -1, 2, -5, 0xffffffff, -0xffffffffLL, 0x100000000, (1LL << 53) - 1, -(1LL << 53)};
    for (int round = 0; round < 20000; ++round) {
        const std::int64_t a = values[random() % 10];
        const std::int64_t b = values[random() % 10];
        const std::int64_t c = values[random() % 10];
        const auto shift = static_cast<unsigned>(random() % 9);
        const BigInteger found =
            BigInteger(a) * BigInteger(b) - BigInteger(c, shift) + BigInteger(a);
        const Int128 expected = Int128{a} * b - Int128{c} * (1 << shift) + a;
        ASSERT_EQ(found.sign(), sign(expected)) << a << ' ' << b << ' ' << c << ' ' << shift;
    }
}

TEST(BigInteger, ShiftsAsFarAsDoublesReach) {
    const BigInteger large(3, 2000);
    EXPECT_EQ((large - BigInteger(3, 1999) - BigInteger(3, 1999)).sign(), 0);
    EXPECT_EQ((large - BigInteger(3, 1999) * BigInteger(2) - BigInteger(1)).sign(), -1);
    EXPECT_EQ((large * large - BigInteger(9, 4000)).sign(), 0);
    EXPECT_EQ((-large).sign(), -1);
    EXPECT_EQ(BigInteger(0, 77).sign(), 0);
}

/// The determinant of whole coordinates up to 2^40.
int expected_orientation(const std::array<std::array<std::int64_t, 3>, 4>& points) {
    const auto difference = [&](std::size_t i, std::size_t axis) {
        return Int128{points[i][axis] - points[0][axis]};
    };
    Int128 determinant = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t k = (i + 1) % 3;
        const std::size_t l = (i + 2) % 3;
        determinant += difference(3, i)
            * (difference(1, k) * difference(2, l) - difference(1, l) * difference(2, k));
    }
    return sign(determinant);
}

Vec3 vector_of(const std::array<std::int64_t, 3>& point, double unit) {
    return {
        unit * static_cast<double>(point[0]),
        unit * static_cast<double>(point[1]),
        unit * static_cast<double>(point[2])};
}

TEST(Orientation, IsThatOfWholeNumbers) {
    std::mt19937_64 random(1988);
    std::array<int, 3> counts = {};
    for (int round = 0; round < 60000; ++round) {
        // Near a plane through few lattice points, moved far off and by few units.
        const std::int64_t size = round % 2 == 0 ? 1 : std::int64_t{1} << 36;
        std::array<std::array<std::int64_t, 3>, 4> points;
        for (auto& point : points)
            for (std::int64_t& coordinate : point)
                coordinate = size * (static_cast<std::int64_t>(random() % 5) - 2)
                    + (random() % 3 == 0 ? static_cast<std::int64_t>(random() % 3) - 1 : 0);
        for (const double unit : {1.0, 0x1p-700, 0x1p200}) {
            const int expected = expected_orientation(points);
            ++counts.at(expected < 0 ? 0 : expected > 0 ? 2 : 1);
            ASSERT_EQ(
                orientation(
                    vector_of(points[0], unit),
                    vector_of(points[1], unit),
                    vector_of(points[2], unit),
                    vector_of(points[3], unit)),
                expected);
        }
    }
    for (const int count : counts)
        EXPECT_GT(count, 10000);
}

TEST(Orientation, SeesTheLastBitOfDecimals) {
    const Vec3 a = {0.1, 0.2, 0.3};
    const Vec3 b = {1.1, 0.7, 0.3};
    const Vec3 c = {0.1, 3.3, 2.2};
    const Vec3 inside = 0.5 * a + 0.5 * b; // nearly on the plane, or on it
    const int side = orientation(a, b, c, inside);
    const Vec3 above = {inside.x, inside.y, std::nextafter(inside.z, 9)};
    const Vec3 below = {inside.x, inside.y, std::nextafter(inside.z, -9)};
    EXPECT_NE(orientation(a, b, c, above), orientation(a, b, c, below));
    EXPECT_LE(std::abs(side), 1);
    EXPECT_EQ(orientation(a, b, c, a), 0);
    EXPECT_EQ(orientation(a, c, b, above), -orientation(a, b, c, above));
}

TEST(Orientation, AlongAnAxisIsTheNormalsSign) {
    std::mt19937 random(8);
    const double values[] = {-2, -1, -0.1, 0, 0.1, 0.3, 1, 2, 1e-200, 1e60};
    const auto value = [&] { return values[random() % 10]; };
    for (int round = 0; round < 20000; ++round) {
        const Vec3 a = {value(), value(), value()};
        const Vec3 b = {value(), value(), value()};
        const Vec3 c = {value(), value(), value()};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Vec3 above = a;
            above[axis] = a[axis] == 1e60 ? 2e60 : a[axis] + 1 + std::abs(a[axis]);
            ASSERT_EQ(orientation_along(axis, a, b, c), orientation(a, b, c, above));
        }
    }
}

} // namespace
} // namespace vera
