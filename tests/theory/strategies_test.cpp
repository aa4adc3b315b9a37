// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/growth.h"
#include "vera/theory/strategies.h"
#include "vera/visible/brute_force.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "theory/terrains.h"
#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

/// But where a triangle has a side exactly at the middle of a pixel, on which either is right.
void expect_to_agree(const ScreenScene& scene, const std::string& what) {
    constexpr std::size_t side = 128;
    constexpr std::int64_t width = screen_size / static_cast<std::int64_t>(side);
    DepthCounts depth;
    QueryCounts rays;
    const PixelSources by_depth = sources_by_depth(scene, side, depth);
    const PixelSources by_cells = sources_by_map(scene, cell_raster(scene), side);
    const PixelSources by_sweep = sources_by_map(scene, plane_sweep(scene), side);
    const GridRays on_grid(scene);
    const PixelSources by_rays = on_grid.sources(on_grid.hits(side, rays));
    EXPECT_EQ(rays.rays, side * side);
    EXPECT_TRUE(by_cells == by_sweep) << what;
    ASSERT_EQ(by_depth.size(), side * side);
    for (std::size_t i = 0; i < by_depth.size(); ++i) {
        if (by_depth[i] == by_cells[i] && by_depth[i] == by_rays[i])
            continue;
        const auto x = static_cast<std::int64_t>(2 * (i % side) + 1) * width;
        const auto y = static_cast<std::int64_t>(2 * (i / side) + 1) * width;
        ASSERT_TRUE(seen_at(scene, x, y).has_side_at) << what << ", pixel " << i;
    }
}

TEST(Strategies, SeeTheSameAtTheMiddleOfEachPixel) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const std::string what = "seed " + std::to_string(seed);
        expect_to_agree(testing::scattered(seed, 300, screen_size >> (seed % 5)), what);
        expect_to_agree(testing::terrain(seed, static_cast<std::int32_t>(4 + 2 * seed)), what);
        expect_to_agree(testing::balls(seed, 4, 12), what);
    }
}

TEST(Strategies, SeeNothingOfNothing) {
    DepthCounts depth;
    EXPECT_EQ(sources_by_depth({}, 4, depth), PixelSources(16, no_source));
    EXPECT_EQ(depth.filled, 0U);
}

TEST(Strategies, LightReachesWhatNothingLiesBefore) {
    ScreenScene scene;
    for (const std::int64_t nearness : {depth_size / 4, 3 * depth_size / 4})
        for (const ScreenPoint point :
             {ScreenPoint{0, 0},
              ScreenPoint{screen_size, 0},
              ScreenPoint{0, screen_size},
              ScreenPoint{screen_size, screen_size}})
            scene.vertices.push_back(
                {{nearness > depth_size / 2 ? point.x / 2 : point.x, point.y}, nearness});
    for (const std::uint32_t first : {0U, 4U}) {
        add_triangle(scene, {first, first + 1, first + 2}, first);
        add_triangle(scene, {first + 1, first + 2, first + 3}, first);
    }
    // The roof over the left half is half as high as the picture is wide: its shadow is 0.3 / 2
    // wide.
    constexpr std::size_t side = 100;
    QueryCounts counts;
    const GridRays rays(scene);
    const std::vector<Hit> hits = rays.hits(side, counts);
    EXPECT_EQ(counts.rays, side * side);
    EXPECT_EQ(rays.lit(hits, {0, 0}, counts), side * side);
    EXPECT_EQ(counts.rays, 2 * side * side);
    EXPECT_EQ(rays.lit(hits, {-0.3, 0}, counts), side * side);
    EXPECT_EQ(rays.lit(hits, {0.3, 0}, counts), side * 85);
    EXPECT_EQ(seen_from(scene, {0.3, 0}).triangles.size(), 4U);
}

struct Growths {
    Growth filled;
    Growth of_sweep;
    Growth of_rays; ///< nodes and tests a ray
};

Growths growths(const std::function<ScreenScene(std::size_t)>& family) {
    std::vector<double> triangles;
    std::vector<double> filled;
    std::vector<double> swept;
    std::vector<double> asked;
    for (const std::size_t size : {128U, 256U, 512U, 1024U, 2048U}) {
        const ScreenScene scene = family(size);
        DepthCounts depth;
        sources_by_depth(scene, 128, depth);
        PlaneSweepCounts sweep;
        plane_sweep(scene, {std::nullopt, &sweep});
        QueryCounts rays;
        GridRays(scene).hits(64, rays);
        triangles.push_back(static_cast<double>(scene.triangles.size()));
        filled.push_back(static_cast<double>(depth.filled));
        swept.push_back(static_cast<double>(sweep.orientations + sweep.comparisons));
        asked.push_back(
            static_cast<double>(rays.cells + rays.tests) / static_cast<double>(rays.rays));
    }
    return {growth(triangles, filled), growth(triangles, swept), growth(triangles, asked)};
}

TEST(Strategies, StepsGrowAsTheTableHasThem) {
    // As many triangles one behind the other, whatever their number: the depth buffer fills as many
    // pixels, and n log n looks like 1.1 to 1.2 here.
    const Growths scatter = growths([](std::size_t count) {
        const double size = screen_size * std::sqrt(40.0 / static_cast<double>(count));
        return testing::scattered(1, count, static_cast<std::int32_t>(size));
    });
    EXPECT_NEAR(scatter.filled.exponent, 0, 0.15);
    EXPECT_LT(scatter.of_sweep.exponent - scatter.of_sweep.uncertainty, 1.25);
    EXPECT_LT(scatter.of_rays.exponent - scatter.of_rays.uncertainty, 0.35);
    // Ever more of one size: the depth buffer fills each, and all of them cross.
    const Growths deep =
        growths([](std::size_t count) { return testing::scattered(2, count, screen_size / 8); });
    EXPECT_NEAR(deep.filled.exponent, 1, 0.1);
    EXPECT_GT(deep.of_sweep.exponent, 1.4);
    EXPECT_LT(deep.of_rays.exponent, 0.75);
}

TEST(Strategies, DepthBufferFillsWithThePixels) {
    const ScreenScene scene = testing::scattered(3, 200, screen_size / 4);
    DepthCounts small;
    DepthCounts large;
    sources_by_depth(scene, 128, small);
    sources_by_depth(scene, 512, large);
    EXPECT_NEAR(static_cast<double>(large.filled) / static_cast<double>(small.filled), 16, 0.3);
}

} // namespace
} // namespace vera
