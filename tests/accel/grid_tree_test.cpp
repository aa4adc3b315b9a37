// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/grid_tree.h"
#include "vera/accel/simd_level.h"

#include <string>

#include "index_answers.h"
#include "random_scene.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::Answers;
using testing::answers;
using testing::coherent_rays;
using testing::detail_in_a_room;
using testing::expect_like_brute_force;
using testing::expect_same;
using testing::mixed_rays;
using testing::random_rays;
using testing::random_scene;
using testing::RandomSceneSettings;

void expect_grid_like_brute_force(
    const Scene& scene,
    const std::vector<QueryRay>& rays,
    const GridSettings& settings,
    const std::string& what) {
    expect_like_brute_force(scene, *make_grid_tree(scene, settings), rays, what);
}

TEST(GridTree, AgreesWithBruteForceOnEveryBit) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        RandomSceneSettings settings;
        settings.items = 1 + seed % 50;
        settings.glass = seed % 2 == 0;
        GridSettings grid;
        grid.crowd = seed % 3 == 0 ? 3 : 16;
        grid.density = seed % 5 == 0 ? 20 : 2;
        const Scene scene = random_scene(seed, settings);
        auto rays = random_rays(seed, 600, 1);
        const auto more = coherent_rays(seed, 600, 1);
        rays.insert(rays.end(), more.begin(), more.end());
        expect_grid_like_brute_force(scene, rays, grid, "seed " + std::to_string(seed));
        if (HasFatalFailure() || HasNonfatalFailure())
            return;
    }
}

TEST(GridTree, GivesTheSameBitsWithEveryInstructionSet) {
    RandomSceneSettings settings;
    settings.items = 60;
    settings.glass = true;
    const Scene scene = random_scene(7, settings);
    const auto rays = mixed_rays(7, 1);
    const auto grid = make_grid_tree(scene);
    const Answers expected = answers(*grid, rays);
    EXPECT_FALSE(simd_levels().empty());
    for (const std::string& level : simd_levels()) {
        ASSERT_TRUE(limit_simd(level));
        const Answers found = answers(*grid, rays);
        expect_same(found, expected, rays, level);
        EXPECT_EQ(found.hit_counts.tests, expected.hit_counts.tests) << level;
        EXPECT_EQ(found.hit_counts.cells, expected.hit_counts.cells) << level;
    }
    EXPECT_FALSE(limit_simd("mmx"));
    EXPECT_TRUE(limit_simd(""));
}

TEST(GridTree, IsTheSameTreeWhateverTheNumberOfThreads) {
    RandomSceneSettings settings;
    settings.items = 400;
    settings.subscenes = 0;
    const Scene scene = random_scene(11, settings);
    GridSettings grid_settings;
    grid_settings.density = 0.1; // crowds
    const auto rays = mixed_rays(11, 1);
    const auto expected_grid = make_grid_tree(scene, grid_settings);
    const Answers expected = answers(*expected_grid, rays);
    EXPECT_GT(expected_grid->statistics().grids, 3U);
    for (const std::size_t threads : {1U, 2U, 7U}) {
        const ThreadLimit limit(threads);
        const auto grid = make_grid_tree(scene, grid_settings);
        EXPECT_EQ(grid->statistics(), expected_grid->statistics()) << threads;
        std::vector<Hit> hits(rays.size());
        std::vector<QueryCounts> counts(rays.size());
        parallel_ranges(rays.size(), 16, [&](std::size_t first, std::size_t last) {
            grid->nearest_hits(
                std::span(rays).subspan(first, last - first),
                std::span(hits).subspan(first, last - first),
                counts[first]);
        });
        EXPECT_EQ(hits, expected.hits) << threads;
    }
}

TEST(GridTree, TestsNoPrimitiveTwiceForARay) {
    // Long slivers lie in many cells, in the inner grids' too.
    Scene scene;
    for (int i = 0; i < 200; ++i) {
        const double at = 0.01 * i;
        scene.geometry.triangles.push_back(
            {{Vec3{-4, -4 + at, -4}, {4, 4 - at, 4}, {4 - at, 4, 4}}});
        scene.geometry.items.push_back(
            {.kind = ItemKind::triangle, .index = static_cast<std::uint32_t>(i)});
    }
    number_primitives(scene);
    GridSettings settings;
    settings.density = 20;
    settings.crowd = 2;
    const auto grid = make_grid_tree(scene, settings);
    EXPECT_GT(grid->statistics().references, 1000U);
    for (const QueryRay& ray : mixed_rays(5, 1)) {
        Hit hit;
        QueryCounts counts;
        grid->nearest_hits({&ray, 1}, {&hit, 1}, counts);
        EXPECT_EQ(counts.rays, 1U);
        ASSERT_LE(counts.tests, 200U);
    }
}

TEST(GridTree, GivesSmallDetailInALargeRoomGridsOfItsOwn) {
    const Scene scene = detail_in_a_room();
    const auto grid = make_grid_tree(scene);
    const GridTreeStatistics statistics = grid->statistics();
    EXPECT_LT(statistics.longest_list, 40U);
    EXPECT_LT(statistics.references, 20 * statistics.elements);
    std::vector<QueryRay> rays(1000);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const double place = 0.0001 * static_cast<double>(i);
        rays[i].ray.origin = {30, 20, 50};
        rays[i].ray.direction = normalized(Vec3{place, 0.037, 0} - rays[i].ray.origin);
    }
    std::vector<Hit> hits(rays.size());
    QueryCounts counts;
    grid->nearest_hits(rays, hits, counts);
    EXPECT_LT(counts.tests, 60 * rays.size());
    expect_grid_like_brute_force(scene, {rays.begin(), rays.begin() + 50}, {}, "room");
}

TEST(GridForecast, CoversTheTreeAndRefusesWhatDoesNotFit) {
    for (const std::uint64_t seed : {1U, 2U}) {
        RandomSceneSettings settings;
        settings.items = 400;
        const Scene scene = random_scene(seed, settings);
        const IndexForecast forecast = grid_forecast(scene);
        const std::size_t bytes = make_grid_tree(scene)->statistics().bytes;
        EXPECT_GE(forecast.bytes, bytes);
        EXPECT_LE(forecast.bytes, 10 * bytes);
        EXPECT_GT(forecast.available_bytes, 1U << 20U);
        GridSettings excessive;
        excessive.crowd_density = 1e12;
        EXPECT_THROW(make_grid_tree(scene, excessive), std::runtime_error);
    }
}

} // namespace
} // namespace vera
