// SPDX-License-Identifier: Apache-2.0
#include "vera/math/transform.h"
#include "vera/scene/outline_table.h"

#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <random>

#include "scene/make_scene.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

class Few {
public:
    explicit Few(unsigned seed)
        : random_(seed) {}

    std::size_t below(std::size_t count) { return random_() % count; }

    double coordinate() {
        constexpr double values[] = {-2, -1, -0.5, -0.0, 0, 0.1, 0.5, 1, 2};
        return values[below(std::size(values))];
    }

    Vec3 point() { return {coordinate(), coordinate(), coordinate()}; }

    Vec3 direction() {
        while (true) {
            const Vec3 result = point();
            if (result != Vec3{})
                return result;
        }
    }

private:
    std::mt19937 random_;
};

/// A wheel with teeth, as often as not a closed way between few points: that one touches and
/// crosses itself, and has equal corners.
std::vector<Vec3> plane_corners(Few& few) {
    const std::size_t count = 9 + few.below(40);
    std::vector<Vec3> corners;
    const bool wheel = few.below(2) == 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double angle =
            6.283185307179586 * static_cast<double>(i) / static_cast<double>(count);
        const double radius = i % 4 < 2 ? 1 : 2;
        if (wheel)
            corners.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
        else
            corners.push_back({few.coordinate(), few.coordinate(), 0});
    }
    return corners;
}

/// Maps to planes through and beside the axes, to tiny and to huge polygons, and near to far
/// places, where coordinates are rounded.
Affine3 random_map(Few& few) {
    constexpr double scales[] = {1, 1, 0.3, 0x1p-40, 0x1p60, 1e-160};
    const double scale = scales[few.below(std::size(scales))];
    const Vec3 turn = few.below(3) == 0 ? 360 * few.point() : 90 * few.point();
    return composed(
        scaling(scale),
        composed(translation(static_cast<double>(few.below(3)) * few.point()), rotation(turn)));
}

double moved(Few& few, double value, double size) {
    constexpr double steps[] = {0, 0, 0x1p-52, -0x1p-52, 0x1p-45, 1e-9, -1e-6, 1e-3};
    return value + size * steps[few.below(std::size(steps))];
}

/// Through a corner, a side, or a point of few values; often moved by a little.
Ray random_ray(Few& few, const Affine3& map, const std::vector<Vec3>& corners) {
    const std::size_t i = few.below(corners.size());
    const Vec3 a = corners[i];
    const Vec3 b = corners[i + 1 == corners.size() ? 0 : i + 1];
    constexpr double parts[] = {0, 0.5, 0.25, 1, -1, 2};
    Vec3 aim = few.below(3) == 0 ? transformed_point(map, {few.coordinate(), few.coordinate(), 0})
                                 : a + parts[few.below(std::size(parts))] * (b - a);
    const double size = max_component(abs(aim));
    aim = {moved(few, aim.x, size), moved(few, aim.y, size), moved(few, aim.z, size)};
    Ray ray;
    ray.origin = transformed_point(map, few.below(8) == 0 ? Vec3{0.5, 0.1, 0} : few.point());
    switch (few.below(4)) {
    case 0: {
        // Along an axis, exactly.
        ray.direction[few.below(3)] = few.below(2) == 0 ? 1 : -1;
        ray.origin = aim - few.coordinate() * ray.direction;
        break;
    }
    case 1:
        ray.direction = b - a; // along a side
        ray.origin = aim - few.coordinate() * ray.direction;
        break;
    default:
        ray.direction = aim - ray.origin;
    }
    if (few.below(8) == 0)
        ray.direction[few.below(3)] = 1e-310;
    if (few.below(4) == 0)
        ray.t_min = -infinity;
    if (few.below(4) == 0)
        ray.t_max = 1;
    return ray;
}

struct Tally {
    std::size_t certain = 0;
    std::size_t inside = 0;
    std::size_t all = 0;
};

void compare(
    const Geometry& geometry, const OutlineTable& table, const Ray& ray, Tally& tally, int round) {
    const Polygon& polygon = geometry.polygons[0];
    const auto corners = corners_of(geometry, polygon);
    const OutlineStrips& outline = *table.of_polygon(0);
    const PreparedRay prepared(ray);
    const auto plain = polygon_crossing(prepared, corners, polygon.normal);
    const auto fast = polygon_crossing(prepared, corners, polygon.normal, table, outline);
    ASSERT_EQ(plain.has_value(), fast.has_value()) << "round " << round;
    if (plain) {
        ASSERT_EQ(std::bit_cast<std::uint64_t>(*plain), std::bit_cast<std::uint64_t>(*fast))
            << "round " << round;
    }

    const double speed = dot(polygon.normal, ray.direction);
    if (speed == 0)
        return;
    const double t = dot(polygon.normal, corners[0] - ray.origin) / speed;
    const InclusionStatus status = inclusion_status(table, outline, corners, prepared, t, speed);
    ++tally.all;
    if (status == InclusionStatus::uncertain)
        return;
    ++tally.certain;
    tally.inside += status == InclusionStatus::inside ? 1 : 0;
    ASSERT_EQ(status == InclusionStatus::inside, meets_outline(prepared, corners))
        << "round " << round;
}

TEST(OutlineTable, GivesTheCrossingsOfThePlainTestOnEveryBit) {
    Few few(1988);
    Tally tally;
    for (int round = 0; round < 4000; ++round) {
        const Affine3 map = random_map(few);
        std::vector<Vec3> corners = plane_corners(few);
        for (Vec3& corner : corners) {
            // Now and then a polygon that is not quite plane, as far as is allowed and farther.
            if (few.below(500) == 0)
                corner.z += 1e-6;
            if (few.below(2000) == 0)
                corner.z += 0.25;
            corner = transformed_point(map, corner);
        }
        Geometry geometry;
        test::add_polygon(geometry, corners, Polygon::Shape::simple);
        const OutlineTable table = outline_table(geometry);
        if (table.of_polygon(0) == nullptr)
            continue; // without area, or of an extraordinary size
        for (int i = 0; i < 100; ++i) {
            compare(geometry, table, random_ray(few, map, corners), tally, round);
            if (HasFatalFailure())
                return;
        }
    }
    EXPECT_GT(tally.all, 200000U);
    EXPECT_GT(tally.certain, tally.all / 3);
    EXPECT_GT(tally.inside, tally.all / 20);
}

TEST(OutlineTable, IsAlmostAlwaysCertainOfRaysThatAreNotAimedAtAnOutline) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> anywhere(-2.5, 2.5);
    Geometry geometry;
    std::vector<Vec3> corners;
    for (int i = 0; i < 144; ++i) {
        const double angle = 6.283185307179586 * i / 144;
        const double radius = i % 4 < 2 ? 1.8 : 2;
        corners.push_back({radius * std::cos(angle), 0.5, radius * std::sin(angle)});
    }
    test::add_polygon(geometry, corners, Polygon::Shape::simple);
    const OutlineTable table = outline_table(geometry);
    Tally tally;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 origin = {anywhere(random), anywhere(random), anywhere(random)};
        const Vec3 aim = {anywhere(random), 0.5, anywhere(random)};
        compare(geometry, table, {origin, aim - origin}, tally, i);
        if (HasFatalFailure())
            return;
    }
    EXPECT_GT(tally.certain, tally.all - tally.all / 1000);
    EXPECT_GT(tally.inside, tally.all / 3);
}

TEST(OutlineTable, TakesMemoryInProportionToTheCorners) {
    // A comb whose teeth all cross every strip.
    for (const int teeth : {10, 1000, 20000}) {
        Geometry geometry;
        std::vector<Vec3> corners = {{0, -1, 0}};
        for (int i = 0; i < teeth; ++i) {
            corners.push_back({i + 0.5, 1, 0});
            corners.push_back({i + 1.0, i + 1 == teeth ? -1.0 : 0.0, 0});
        }
        test::add_polygon(geometry, corners, Polygon::Shape::simple);
        const OutlineTable table = outline_table(geometry);
        ASSERT_NE(table.of_polygon(0), nullptr);
        EXPECT_LE(memory(table), most_memory_of_outline_table(geometry));
        EXPECT_LT(memory(table), 200 + 40 * corners.size());
    }
}

TEST(OutlineTable, HoldsOnlyPlanePolygonsOfManyCorners) {
    Geometry geometry;
    test::add_polygon(geometry, {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}});
    EXPECT_TRUE(outline_table(geometry).numbers.empty());
    std::vector<Vec3> corners;
    corners.reserve(20);
    for (int i = 0; i < 20; ++i)
        corners.push_back({std::cos(0.3 * i), std::sin(0.3 * i), 0});
    test::add_polygon(geometry, corners);
    const OutlineTable table = outline_table(geometry);
    EXPECT_EQ(table.of_polygon(0), nullptr);
    EXPECT_NE(table.of_polygon(1), nullptr);
    EXPECT_EQ(table.of_polygon(2), nullptr);
    corners[3].x = infinity;
    Geometry endless;
    test::add_polygon(endless, corners);
    EXPECT_EQ(outline_table(endless).of_polygon(0), nullptr);
}

} // namespace
} // namespace vera
