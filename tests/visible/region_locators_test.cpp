// SPDX-License-Identifier: Apache-2.0
// The structures that locate points in maps, against looking at each border and at each triangle.
#include "vera/exact/rational_orientation.h"
#include "vera/visible/brute_force.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/plane_sweep.h"
#include "vera/visible/region_locator.h"
#include "vera/visible/triangle_hierarchy.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr std::array<std::pair<LocatorKind, const char*>, 3> kinds = {
    {{LocatorKind::hierarchy, "hierarchy"},
     {LocatorKind::slabs, "slabs"},
     {LocatorKind::grid, "grid"}}};

/// Of few values, of holes, of edges through one point, and none at all.
std::vector<ScreenScene> scenes() {
    std::vector<ScreenScene> result;
    for (std::uint64_t seed = 0; seed < 60; ++seed)
        result.push_back(testing::layers(seed, 1 + seed % 40, std::int32_t{1} << (1 + seed % 4)));
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        result.push_back(testing::scattered(seed, 150, screen_size >> seed));
        result.push_back(testing::terrain(seed, 4 << (seed % 3)));
        result.push_back(testing::slivers(seed, 40));
    }
    result.push_back(testing::nested_holes(5));
    result.push_back(testing::star(30));
    result.push_back(testing::balls(1, 3, 8));
    result.emplace_back();
    return result;
}

/// Points anywhere, on few rows and columns, at corners of the map and on its borders.
std::vector<MapPoint> points_of(const MapSegments& map, std::uint64_t seed, std::size_t count) {
    std::mt19937_64 random(seed);
    const auto coordinate = [&] {
        const std::uint64_t bits = random();
        return static_cast<double>(bits % 2 == 0 ? bits >> 42U : (bits >> 8U) % 33 << 17U)
            + (bits % 3 == 0 ? static_cast<double>(bits >> 12U & 0xfffffU) * 0x1p-20 : 0);
    };
    std::vector<MapPoint> points;
    while (points.size() < count) {
        const double x = coordinate();
        const double y = coordinate();
        points.push_back(map_point(x, y));
        if (map.segments.empty())
            continue;
        points.push_back(map.points[random() % map.points.size()]);
        const auto segment = static_cast<std::uint32_t>(random() % map.segments.size());
        const double part = static_cast<double>(random() % 17) / 16;
        const MapPoint& begin = map.begin(segment);
        const MapPoint& end = map.end(segment);
        points.push_back(
            map_point(begin.x + part * (end.x - begin.x), begin.y + part * (end.y - begin.y)));
    }
    return points;
}

/// The regions that are right at the point: that of the reference, or of borders through it.
std::set<std::uint32_t> regions_at(const MapSegments& map, const MapPoint& point) {
    std::set<std::uint32_t> result;
    for (std::uint32_t i = 0; i < map.segments.size(); ++i)
        if (map.side(i, point) == 0 && order(map.begin(i), point) <= 0
            && order(point, map.end(i)) <= 0) {
            result.insert(map.segments[i].above);
            result.insert(map.segments[i].below);
        }
    return result;
}

void expect_all_agree(const VisibleMap& map, std::uint64_t seed, std::size_t count) {
    const MapSegments segments = map_segments(map);
    const auto reference = make_brute_force_locator(map);
    std::vector<std::unique_ptr<RegionLocator>> locators;
    for (const auto& [kind, name] : kinds)
        locators.push_back(make_locator(kind, map));
    LocatorSteps steps;
    for (const MapPoint& point : points_of(segments, seed, count)) {
        const std::uint32_t expected = reference->region_at(point, steps);
        const std::set<std::uint32_t> at_border = regions_at(segments, point);
        for (std::size_t i = 0; i < kinds.size(); ++i) {
            const std::uint32_t found = locators[i]->region_at(point, steps);
            if (at_border.empty())
                ASSERT_EQ(found, expected)
                    << kinds[i].second << " " << point.x << " " << point.y << " seed " << seed;
            else
                ASSERT_TRUE(at_border.count(found) == 1)
                    << kinds[i].second << " " << point.x << " " << point.y << " seed " << seed;
        }
    }
}

TEST(RegionLocators, AgreeWithEachOtherAndWithLookingAtEachBorder) {
    // 100 000 points in all.
    std::uint64_t seed = 0;
    for (const ScreenScene& scene : scenes()) {
        expect_all_agree(visible_map(scene, cell_raster(scene)), ++seed, 1320);
        if (HasFatalFailure())
            return;
    }
}

TEST(RegionLocators, AgreeOnMapsOfThePlaneSweepAndOfThingsThatWereCutWhereTheyPenetrate) {
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
        const ScreenScene layers = testing::layers(seed, 25, 8);
        expect_all_agree(visible_map(layers, plane_sweep(layers)), seed, 150);
        ScreenScene tangle = testing::tangle(seed, 6 + seed, seed % 2 == 0 ? 0 : 8);
        const WholePieces whole = whole_pieces(tangle);
        const VisibleMap map = visible_map(tangle, whole.pieces);
        if (map.joined == 0)
            expect_all_agree(map, seed, 300);
        if (HasFatalFailure())
            return;
    }
}

TEST(RegionLocators, FindWhatIsSeenWhereWaysRoundItHadToBeJoined) {
    std::mt19937_64 random(5);
    int joined = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        ScreenScene tangle = testing::tangle(seed, 10 + seed, seed % 2 == 0 ? 0 : 8);
        const WholePieces whole = whole_pieces(tangle);
        const VisibleMap map = visible_map(tangle, whole.pieces);
        if (map.joined == 0)
            continue;
        ++joined;
        std::vector<std::unique_ptr<RegionLocator>> locators;
        for (const auto& [kind, name] : kinds)
            try {
                locators.push_back(make_locator(kind, map));
            } catch (const CrossingBorders&) {
                EXPECT_NE(kind, LocatorKind::grid);
            }
        for (int i = 0; i < 300; ++i) {
            const auto x = static_cast<std::int64_t>(random() % (2 * std::uint64_t{screen_size}));
            const auto y = static_cast<std::int64_t>(random() % (2 * std::uint64_t{screen_size}));
            const SeenAt expected = seen_at(tangle, x, y);
            if (expected.has_side_at)
                continue;
            LocatorSteps steps;
            for (const auto& locator : locators) {
                const std::uint32_t region = locator->region_at(
                    map_point(static_cast<double>(x) / 2, static_cast<double>(y) / 2), steps);
                const std::uint32_t source =
                    region == no_region ? no_source : map.regions[region].source;
                ASSERT_EQ(source, expected.source) << "seed " << seed << " " << x << " " << y;
            }
        }
    }
    EXPECT_GT(joined, 10);
}

TEST(RegionLocators, FindWhatAskingEveryTriangleTells) {
    std::mt19937_64 random(1);
    int compared = 0;
    for (const ScreenScene& scene : scenes()) {
        const VisibleMap map = visible_map(scene, cell_raster(scene));
        std::vector<std::unique_ptr<RegionLocator>> locators;
        for (const auto& [kind, name] : kinds)
            locators.push_back(make_locator(kind, map));
        for (int i = 0; i < 100; ++i) {
            const auto x = static_cast<std::int64_t>(random() % (2 * std::uint64_t{screen_size}));
            const auto y = static_cast<std::int64_t>(random() % (2 * std::uint64_t{screen_size}));
            const SeenAt expected = seen_at(scene, x, y);
            if (expected.has_side_at)
                continue;
            ++compared;
            LocatorSteps steps;
            for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
                const std::uint32_t region = locators[kind]->region_at(
                    map_point(static_cast<double>(x) / 2, static_cast<double>(y) / 2), steps);
                const std::uint32_t source =
                    region == no_region ? no_source : map.regions[region].source;
                ASSERT_EQ(source, expected.source) << kinds[kind].second << " " << x << " " << y;
            }
        }
    }
    EXPECT_GT(compared, 5000);
}

TEST(RegionLocators, RoundPointsToPartsOfSteps) {
    EXPECT_EQ(map_point(1.25, 7).x, 1.25);
    EXPECT_EQ(map_point(-3, 1e30).x, 0);
    EXPECT_EQ(map_point(-3, 1e30).y, screen_size);
    EXPECT_EQ(map_point(0x1p-21, 0x1p-22).x, 0x1p-20);
    EXPECT_EQ(map_point(0x1p-21, 0x1p-22).y, 0);
}

/// A brute force with fractions of 256 bits and more would be the same code; these have few bits.
TEST(RationalOrientation, IsThatOfTheGridWhereDenominatorsAreTakenAway) {
    std::mt19937_64 random(3);
    const auto numerator = [&](std::int64_t below) {
        return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(below));
    };
    int collinear = 0;
    for (int i = 0; i < 100'000; ++i) {
        std::array<RationalPoint, 3> points;
        std::array<ScreenPoint, 3> scaled;
        for (std::size_t j = 0; j < 3; ++j) {
            // In 60ths of a step, of which the fractions are parts.
            constexpr std::array<std::int64_t, 5> denominators = {1, 2, 3, 12, 60};
            const std::int64_t denominator = denominators[random() % denominators.size()];
            const std::int64_t whole_x = numerator(3);
            const std::int64_t whole_y = numerator(3);
            const std::int64_t part_x = numerator(denominator);
            const std::int64_t part_y = numerator(denominator);
            points[j] = {
                {static_cast<std::int32_t>(whole_x), static_cast<std::int32_t>(whole_y)},
                part_x,
                part_y,
                denominator};
            scaled[j] = {
                static_cast<std::int32_t>(whole_x * 60 + part_x * 60 / denominator),
                static_cast<std::int32_t>(whole_y * 60 + part_y * 60 / denominator)};
        }
        const std::int64_t expected = orientation(scaled[0], scaled[1], scaled[2]);
        collinear += expected == 0 ? 1 : 0;
        ASSERT_EQ(orientation(points[0], points[1], points[2]), sign(expected));
        ASSERT_EQ(
            side(map_point(points[0]), map_point(points[1]), map_point(points[2])), sign(expected));
    }
    EXPECT_GT(collinear, 1000);
}

TEST(RationalOrientation, TellsCrossingsFromPointsBesideThem) {
    std::mt19937_64 random(4);
    const auto point = [&] {
        const auto x = static_cast<std::int32_t>(random() % (screen_size + 1U));
        const auto y = static_cast<std::int32_t>(random() % (screen_size + 1U));
        return ScreenPoint{x, y};
    };
    int compared = 0;
    while (compared < 20'000) {
        const ScreenPoint a = point();
        const ScreenPoint b = point();
        const ScreenPoint p = point();
        const ScreenPoint q = point();
        if (sign(orientation(p, q, a)) * sign(orientation(p, q, b)) >= 0
            || sign(orientation(a, b, p)) * sign(orientation(a, b, q)) >= 0)
            continue;
        ++compared;
        const RationalPoint crossing = point_at(a, b, crossing_place(a, b, p, q));
        const MapPoint from = map_point(RationalPoint{a});
        const MapPoint to = map_point(RationalPoint{b});
        ASSERT_EQ(side(from, to, map_point(crossing)), 0);
        ASSERT_EQ(side(from, map_point(crossing), to), 0);
        // As little beside it as its denominator tells apart.
        RationalPoint beside = crossing;
        if (beside.y_numerator + 1 == beside.denominator || a.x == b.x)
            continue;
        ++beside.y_numerator;
        ASSERT_EQ(side(from, to, map_point(beside)), a.x < b.x ? 1 : -1);
        ASSERT_EQ(order(map_point(crossing), map_point(beside)), -1);
        ASSERT_EQ(order_by_x(map_point(crossing), map_point(beside)), 0);
    }
}

} // namespace
} // namespace vera
