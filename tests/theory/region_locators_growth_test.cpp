// SPDX-License-Identifier: Apache-2.0
// How fast the steps of point location in maps grow (VERA 3.2): O(log m) a query, and O(m log m) to
// build what answers it. Counted, and so the same on every machine.
#include "vera/theory/growth.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/region_locator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

struct Counted {
    std::vector<double> borders;
    std::vector<double> logarithms;
    std::vector<double> mean;  ///< steps of a query
    std::vector<double> worst; ///< of 2000 queries
    std::vector<double> build;
    std::vector<double> build_bound; ///< m log m
    std::vector<double> bytes;
};

void count(LocatorKind kind, const ScreenScene& scene, Counted& counted) {
    constexpr int queries = 2000;
    const VisibleMap map = visible_map(scene, cell_raster(scene));
    const auto locator = make_locator(kind, map);
    const auto borders = static_cast<double>(map_segments(map).segments.size());
    std::mt19937_64 random(1);
    LocatorSteps all;
    std::uint64_t worst = 0;
    for (int i = 0; i < queries; ++i) {
        LocatorSteps steps;
        const auto x = static_cast<double>(random() >> 42U);
        const auto y = static_cast<double>(random() >> 42U);
        locator->region_at(map_point(x, y), steps);
        worst = std::max(worst, steps.comparisons);
        all += steps;
    }
    EXPECT_EQ(all.queries, std::uint64_t{queries});
    counted.borders.push_back(borders);
    counted.logarithms.push_back(std::log2(borders));
    counted.mean.push_back(static_cast<double>(all.comparisons) / queries);
    counted.worst.push_back(static_cast<double>(worst));
    counted.build.push_back(static_cast<double>(locator->build_steps()));
    counted.build_bound.push_back(borders * std::log2(borders));
    counted.bytes.push_back(static_cast<double>(locator->memory()));
    EXPECT_LE(
        static_cast<double>(locator->memory()),
        locator_bytes(kind, static_cast<double>(map.ring_vertices.size())));
}

/// Of triangles that overlap as much whatever their number, and of a mesh.
ScreenScene scene_of(bool is_mesh, std::int32_t size) {
    return is_mesh ? testing::terrain(1, size)
                   : testing::scattered(
                       1,
                       static_cast<std::size_t>(size) * static_cast<std::size_t>(size),
                       2 * screen_size / size);
}

Counted counted_of(LocatorKind kind, bool is_mesh) {
    Counted counted;
    for (const std::int32_t size : {8, 12, 16, 24, 32, 48, 64})
        count(kind, scene_of(is_mesh, size), counted);
    return counted;
}

void expect_at_most(
    double exponent,
    const std::vector<double>& sizes,
    const std::vector<double>& counts,
    const char* what) {
    const Growth found = growth(sizes, counts);
    EXPECT_LE(found.exponent - found.uncertainty, exponent) << what;
}

TEST(RegionLocators, TakeStepsThatGrowWithTheLogarithmOfTheBorders) {
    for (const LocatorKind kind : {LocatorKind::hierarchy, LocatorKind::slabs})
        for (const bool is_mesh : {false, true}) {
            const Counted counted = counted_of(kind, is_mesh);
            // From 7 to 13 or 8 to 15, as the logarithm does here, is a power of 0.13 to 0.15.
            expect_at_most(0.15, counted.borders, counted.mean, "mean");
            expect_at_most(0.15, counted.borders, counted.worst, "worst");
            const double factor = kind == LocatorKind::slabs ? 2 : 8;
            for (std::size_t i = 0; i < counted.mean.size(); ++i)
                EXPECT_LE(counted.mean[i], factor * counted.logarithms[i]);
        }
}

TEST(RegionLocators, TakeAFixedNumberOfStepsInAGridOnTheAverage) {
    for (const bool is_mesh : {false, true}) {
        const Counted counted = counted_of(LocatorKind::grid, is_mesh);
        expect_at_most(0.05, counted.borders, counted.mean, "mean");
    }
}

TEST(RegionLocators, AreBuiltInStepsThatGrowWithTheBordersTimesTheirLogarithm) {
    for (const LocatorKind kind : {LocatorKind::hierarchy, LocatorKind::slabs, LocatorKind::grid})
        for (const bool is_mesh : {false, true}) {
            const Counted counted = counted_of(kind, is_mesh);
            // What is less than m log m counts less the more borders there are.
            expect_at_most(1.05, counted.build_bound, counted.build, "steps");
            expect_at_most(1.01, counted.borders, counted.bytes, "bytes");
        }
}

} // namespace
} // namespace vera
