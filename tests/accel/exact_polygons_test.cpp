// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/exact_polygons.h"
#include "vera/accel/exact_triangles.h"
#include "vera/scene/polygon_crossing.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <vector>

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
    const double x = few(random);
    const double y = few(random);
    return {x, y, few(random)};
}

void put_ray(Frame& frame, std::size_t lane, const Ray& ray) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        frame.rays.origin[axis][lane] = ray.origin[axis];
        frame.rays.direction[axis][lane] = ray.direction[axis];
    }
    frame.rays.t_min[lane] = ray.t_min;
    frame.rays.t_max[lane] = ray.t_max;
    frame.rays.origin_error[lane] = ray.origin_error;
}

Ray ranged_ray(std::mt19937_64& random, Vec3 origin, Vec3 direction) {
    constexpr double forever = std::numeric_limits<double>::infinity();
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    ray.t_min = std::array{0.0, 0.0, 0.5, -forever}[random() % 4];
    ray.t_max = random() % 2 == 0 ? forever : 1;
    ray.origin_error = random() % 4 == 0 ? 1e-9 : 0;
    return ray;
}

Vec3 unit_or_zero(Vec3 v) {
    const double length = std::sqrt(dot(v, v));
    return length > 0 ? v / length : v;
}

TEST(ExactPolygons, QuadranglesAreCrossedLikeOneByOneToTheBit) {
    std::mt19937_64 random(5);
    const auto frame = std::make_unique<Frame>();
    std::size_t crossings = 0;
    for (int round = 0; round < 20'000; ++round) {
        std::array<std::array<Vec3, 4>, packet_size> corners;
        std::array<Vec3, packet_size> normals;
        QuadrangleRows rows;
        for (std::size_t lane = 0; lane < packet_size; ++lane) {
            const Vec3 origin = few_point(random);
            put_ray(*frame, lane, ranged_ray(random, origin, few_point(random)));
            // A parallelogram or, as often, any four points.
            const Vec3 corner = few_point(random);
            const Vec3 e = few_point(random);
            const Vec3 f = few_point(random);
            corners[lane] = {corner, corner + e, corner + e + f, corner + f};
            if (random() % 2 == 0)
                corners[lane][2] = few_point(random);
            normals[lane] = unit_or_zero(cross(e, f));
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (std::size_t i = 0; i < 4; ++i)
                    rows.corners[i][axis][lane] = corners[lane][i][axis];
                rows.normal[axis][lane] = normals[lane][axis];
            }
        }
        const auto lanes = static_cast<LaneMask>(random());
        RayRows::Row t;
        prepare_rays(*frame);
        const LaneMask met = cross_quadrangles(*frame, lanes, rows, t);
        EXPECT_EQ(met & ~lanes, 0U);
        for (std::size_t lane = 0; lane < packet_size; ++lane) {
            if ((lanes >> lane & 1U) == 0)
                continue;
            const std::optional<double> expected =
                polygon_crossing(PreparedRay(frame->rays.ray(lane)), corners[lane], normals[lane]);
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

/// A geometry of one polygon of many corners: a wheel with teeth in a plane across one of the axes,
/// or one that leans.
Geometry wheel(std::mt19937_64& random) {
    const std::size_t count = 12 + 4 * (random() % 30);
    const std::size_t kind = random() % 4;
    Geometry geometry;
    for (std::size_t i = 0; i < count; ++i) {
        const double angle =
            6.283185307179586 * static_cast<double>(i) / static_cast<double>(count);
        const double radius = i % 4 < 2 ? 1 : 2;
        const double u = radius * std::cos(angle);
        const double v = radius * std::sin(angle);
        const std::array<Vec3, 4> places = {
            {{u, v, 0.5}, {v, 0.5, u}, {0.5, u, v}, {0.6 * u, v, 0.8 * u}}};
        geometry.corners.push_back(places[kind]);
    }
    const std::array<Vec3, 4> normals = {{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {-0.8, 0, 0.6}}};
    Polygon polygon;
    polygon.first_corner = 0;
    polygon.corner_count = static_cast<std::uint32_t>(count);
    polygon.normal = normals[kind];
    polygon.shape = Polygon::Shape::simple;
    geometry.polygons.push_back(polygon);
    return geometry;
}

TEST(ExactPolygons, PolygonsOfManyCornersAreCrossedLikeOneByOneToTheBit) {
    std::mt19937_64 random(7);
    const auto frame = std::make_unique<Frame>();
    std::uniform_real_distribution<double> place(-2.2, 2.2);
    std::size_t crossings = 0;
    std::size_t missed = 0;
    std::size_t undecided = 0;
    for (int round = 0; round < 4'000; ++round) {
        const Geometry geometry = wheel(random);
        const OutlineTable table = outline_table(geometry);
        const OutlineStrips* const outline = table.of_polygon(0);
        ASSERT_NE(outline, nullptr);
        for (std::size_t lane = 0; lane < packet_size; ++lane) {
            // To any place, to a corner, or between few points.
            const double x = place(random);
            const double y = place(random);
            const Vec3 anywhere = {x, y, place(random)};
            const Vec3 corner = geometry.corners[random() % geometry.corners.size()];
            const std::array<Vec3, 4> ends = {anywhere, anywhere, corner, few_point(random)};
            const Vec3 end = ends[random() % ends.size()];
            const Vec3 origin = random() % 8 == 0 ? corner : few_point(random);
            const Vec3 direction = random() % 32 == 0 ? few_point(random) : end - origin;
            put_ray(*frame, lane, ranged_ray(random, origin, direction));
        }
        const auto lanes = static_cast<LaneMask>(random());
        PolygonCrossings found;
        prepare_rays(*frame);
        const Vec3 normal = geometry.polygons.front().normal;
        cross_polygon(*frame, lanes, geometry.corners.front(), normal, table, *outline, found);
        EXPECT_EQ((found.met | found.undecided) & ~lanes, 0U);
        EXPECT_EQ(found.met & found.undecided, 0U);
        undecided += static_cast<std::size_t>(std::popcount(found.undecided));
        for (LaneMask rest = lanes & ~found.undecided; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            const std::optional<double> expected =
                polygon_crossing(PreparedRay(frame->rays.ray(lane)), geometry.corners, normal);
            ASSERT_EQ((found.met >> lane & 1U) != 0, expected.has_value());
            if (!expected) {
                ++missed;
                continue;
            }
            ++crossings;
            ASSERT_EQ(
                std::bit_cast<std::uint64_t>(found.t[lane]),
                std::bit_cast<std::uint64_t>(*expected));
        }
    }
    EXPECT_GT(crossings, 1000U);
    EXPECT_GT(missed, 1000U);
    EXPECT_GT(undecided, 100U);
    EXPECT_LT(undecided, crossings + missed);
}

} // namespace
} // namespace vera::detail
