// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/kinetic_order.h"

#include <algorithm>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "theory/rectangles.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using Points = std::vector<PlanePoint>;

Points
some_points(std::size_t count, std::int32_t slope, std::int32_t reach, std::mt19937_64& random) {
    Points points(count);
    for (PlanePoint& point : points) {
        point.x = testing::any_within(slope, random);
        point.y = testing::any_within(reach, random);
    }
    return points;
}

/// What is left of rays that were removed.
std::vector<std::uint32_t> rays_in_order(const KineticOrder& order) {
    std::vector<std::uint32_t> rays;
    for (std::uint32_t place = 0; place < order.size(); ++place)
        if (order.at(place) != KineticOrder::none) {
            EXPECT_EQ(order.place(order.at(place)), place);
            rays.push_back(order.at(place));
        }
    return rays;
}

/// slope z + offset, times the denominator.
std::int64_t scaled_value(PlanePoint point, CrossingZ z) {
    return point.x * z.numerator + point.y * z.denominator;
}

void expect_sorted(const KineticOrder& order, const Points& points, CrossingZ z) {
    const auto rays = rays_in_order(order);
    EXPECT_TRUE(std::is_sorted(rays.begin(), rays.end(), [&](std::uint32_t a, std::uint32_t b) {
        return scaled_value(points[a], z) < scaled_value(points[b], z);
    }));
}

/// Lines that meet behind first_z, up to last_z.
std::size_t crossing_count(const Points& points, std::int32_t first_z, std::int32_t last_z) {
    const auto sign = [](std::int64_t value) { return (value > 0) - (value < 0); };
    const auto before = [&](PlanePoint a, PlanePoint b, std::int32_t z) {
        const int order = sign(scaled_value(b, {z, 1}) - scaled_value(a, {z, 1}));
        return order != 0 ? order : sign(std::int64_t{b.x} - a.x);
    };
    std::size_t count = 0;
    for (const PlanePoint a : points)
        for (const PlanePoint b : points)
            if (before(a, b, first_z) > 0 && before(a, b, last_z) < 0)
                ++count;
    return count;
}

TEST(KineticOrder, IsSortedAtEveryCrossingAndPassesEachOnce) {
    std::mt19937_64 random(1988);
    std::uint64_t crossings = 0;
    for (int round = 0; round < 300; ++round) {
        // Of few values: many cross at one place, are the same, or are level.
        const std::int32_t reach = round % 3 == 0 ? 50 : 4;
        const Points points = some_points(random() % 24, round % 2 == 0 ? 2 : 9, reach, random);
        const std::int32_t first_z = testing::any_within(3, random);
        const auto last_z = static_cast<std::int32_t>(first_z + static_cast<int>(random() % 7));
        KineticOrder order(points, first_z, last_z);
        expect_sorted(order, points, {first_z, 1});
        std::set<std::pair<std::uint32_t, std::uint32_t>> passed;
        CrossingZ z = {first_z, 1};
        while (const auto crossing = order.next()) {
            EXPECT_FALSE(crossing->z < z) << "they come in their order";
            EXPECT_FALSE((CrossingZ{last_z, 1} < crossing->z));
            z = crossing->z;
            EXPECT_TRUE(passed.insert(std::minmax(crossing->left, crossing->right)).second);
            order.pass();
            expect_sorted(order, points, z);
            EXPECT_LT(order.place(crossing->right), order.place(crossing->left));
        }
        expect_sorted(order, points, {last_z, 1});
        EXPECT_EQ(order.passed(), passed.size());
        EXPECT_EQ(order.passed(), crossing_count(points, first_z, last_z));
        crossings += order.passed();
    }
    EXPECT_GT(crossings, 5000U);
}

TEST(KineticOrder, GoesOnWithoutWhatIsRemoved) {
    std::mt19937_64 random(2);
    for (int round = 0; round < 200; ++round) {
        Points points = some_points(20, 3, 6, random);
        KineticOrder order(points, 0, 8);
        std::vector<std::uint32_t> left = rays_in_order(order);
        CrossingZ z = {0, 1};
        while (const auto crossing = order.next()) {
            z = crossing->z;
            order.pass();
            if (random() % 3 == 0) {
                const std::size_t which = random() % left.size();
                order.remove(left[which]);
                left.erase(left.begin() + static_cast<std::ptrdiff_t>(which));
                if (left.empty())
                    break;
            }
            expect_sorted(order, points, z);
        }
        expect_sorted(order, points, {8, 1});
        auto found = rays_in_order(order);
        std::sort(found.begin(), found.end());
        std::sort(left.begin(), left.end());
        EXPECT_EQ(found, left);
    }
}

TEST(KineticOrder, HasNoCrossingsOfRaysFromOnePoint) {
    Points points;
    for (std::int32_t slope = -50; slope <= 50; ++slope)
        points.push_back({slope, 7 * slope + 3}); // all at (3, -7)
    EXPECT_FALSE(KineticOrder(points, -7, 1000).next());
    const auto turned = KineticOrder(points, -8, 1000).next();
    ASSERT_TRUE(turned) << "from before the point on they all cross there";
    EXPECT_EQ(turned->z.numerator, -7 * turned->z.denominator);
}

TEST(KineticOrder, ComparesTheLargestNumbersExactly) {
    constexpr std::int32_t most = largest_plane_coordinate;
    // The first one crosses the others at -most / (most - 1) and -1, which differ by 2^-30.
    const Points points = {{most, most}, {1, 0}, {0, 0}};
    KineticOrder order(points, -2, 0);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> passed;
    while (const auto crossing = order.next()) {
        passed.emplace_back(crossing->left, crossing->right);
        order.pass();
    }
    EXPECT_EQ(
        passed, (std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 1}, {0, 2}, {1, 2}}));
}

} // namespace
} // namespace vera
