// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/wide_bvh.h"

#include <string>

#include "index_answers.h"
#include "random_scene.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::Answers;
using testing::answers;
using testing::detail_in_a_room;
using testing::expect_like_brute_force;
using testing::mixed_rays;
using testing::random_scene;
using testing::RandomSceneSettings;

TEST(WideBvh, IsTheSameTreeWhateverTheNumberOfThreads) {
    const Scene scene = detail_in_a_room();
    auto rays = mixed_rays(11, 1);
    for (QueryRay& query : rays)
        query.ray.direction = Vec3{0.05, 0.05, 0} - query.ray.origin;
    const auto expected_index = make_wide_bvh(scene);
    const Answers expected = answers(*expected_index, rays);
    EXPECT_GT(expected_index->statistics().levels, 2U);
    for (const std::size_t threads : {1U, 2U, 7U}) {
        const ThreadLimit limit(threads);
        const auto index = make_wide_bvh(scene);
        EXPECT_EQ(index->statistics(), expected_index->statistics()) << threads;
        std::vector<Hit> hits(rays.size());
        std::vector<QueryCounts> counts(rays.size());
        parallel_ranges(rays.size(), 16, [&](std::size_t first, std::size_t last) {
            index->nearest_hits(
                std::span(rays).subspan(first, last - first),
                std::span(hits).subspan(first, last - first),
                counts[first]);
        });
        EXPECT_EQ(hits, expected.hits) << threads;
    }
}

TEST(WideBvh, HoldsElementsThatNoCutTellsApart) {
    Scene scene;
    for (std::uint32_t i = 0; i < 5000; ++i) {
        scene.geometry.spheres.push_back({{1, 2, 3}, 1});
        scene.geometry.items.push_back({.kind = ItemKind::sphere, .index = i});
    }
    number_primitives(scene);
    const auto index = make_wide_bvh(scene);
    EXPECT_LT(index->statistics().levels, 15U);
    expect_like_brute_force(scene, *index, mixed_rays(3, 1), "the same sphere 5000 times");
}

TEST(WideBvh, BoundsItsDepthWhereSizesShrinkWithoutEnd) {
    // Each a third as large and as far as the one before it: cuts by surface take them off one by
    // one.
    Scene scene;
    double size = 1;
    for (std::uint32_t i = 0; i < 600; ++i) {
        scene.geometry.spheres.push_back({{size, 0, 0}, 0.3 * size});
        scene.geometry.items.push_back({.kind = ItemKind::sphere, .index = i});
        size /= 3;
    }
    number_primitives(scene);
    const auto index = make_wide_bvh(scene);
    EXPECT_LT(index->statistics().levels, 60U);
    expect_like_brute_force(scene, *index, mixed_rays(4, 1), "shrinking spheres");
}

TEST(WideBvh, TestsFewOfTheElementsOfSmallDetailInALargeRoom) {
    const Scene scene = detail_in_a_room();
    const auto index = make_wide_bvh(scene);
    std::vector<QueryRay> rays(1000);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const double place = 0.0001 * static_cast<double>(i);
        rays[i].ray.origin = {30, 20, 50};
        rays[i].ray.direction = normalized(Vec3{place, 0.037, 0} - rays[i].ray.origin);
    }
    std::vector<Hit> hits(rays.size());
    QueryCounts counts;
    index->nearest_hits(rays, hits, counts);
    EXPECT_LT(counts.tests, 60 * rays.size());
    expect_like_brute_force(scene, *index, {rays.begin(), rays.begin() + 50}, "room");
}

TEST(WideBvh, FindsWhatIsSmallBesideWhatIsHugeInFewMoreTests) {
    Scene scene;
    std::vector<QueryRay> rays(400);
    for (std::uint32_t i = 0; i < 8000; ++i) {
        const auto place = [](std::uint32_t number) { return 0.1 * (number % 20) - 0.95; };
        scene.geometry.spheres.push_back({{place(i), place(i / 20), place(i / 400)}, 0.01});
        scene.geometry.items.push_back({.kind = ItemKind::sphere, .index = i});
    }
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
        rays[i].ray.origin = {3, 0.2, 0.1};
        rays[i].ray.direction = normalized(Vec3{-3, 0.1 * (i % 20) - 1, 0.1 * (i / 20) - 1});
    }
    const auto tests = [&] {
        number_primitives(scene);
        std::vector<Hit> hits(rays.size());
        QueryCounts counts;
        make_wide_bvh(scene)->nearest_hits(rays, hits, counts);
        return static_cast<double>(counts.tests);
    };
    const double before = tests();
    constexpr double huge = 1e6;
    scene.geometry.triangles.push_back(
        {{Vec3{-huge, -1, -huge}, {huge, -1, -huge}, {0, -1, huge}}});
    scene.geometry.items.push_back({.kind = ItemKind::triangle});
    EXPECT_LT(tests(), 2 * before);
}

TEST(WideBvh, ForecastsWhatItTakes) {
    for (const std::uint64_t seed : {1U, 2U}) {
        RandomSceneSettings settings;
        settings.items = 400;
        const Scene scene = random_scene(seed, settings);
        const IndexForecast forecast = wide_bvh_forecast(scene);
        const std::size_t bytes = make_wide_bvh(scene)->statistics().bytes;
        EXPECT_GE(forecast.bytes, bytes);
        EXPECT_LE(forecast.bytes, 10 * bytes);
        EXPECT_GT(forecast.available_bytes, 1U << 20U);
    }
}

} // namespace
} // namespace vera
