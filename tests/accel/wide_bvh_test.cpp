// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/simd_level.h"
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
using testing::expect_same;
using testing::mixed_rays;
using testing::random_scene;
using testing::RandomSceneSettings;

TEST(WideBvh, AgreesWithBruteForceOnEveryBit) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        RandomSceneSettings settings;
        settings.items = 1 + 2 * seed;
        settings.glass = seed % 2 == 0;
        const Scene scene = random_scene(seed, settings);
        expect_like_brute_force(
            scene, *make_wide_bvh(scene), mixed_rays(seed, 1), "seed " + std::to_string(seed));
        if (HasFatalFailure() || HasNonfatalFailure())
            return;
    }
}

TEST(WideBvh, AgreesInAnyUnitOfLengthAndScalesItsAnswers) {
    RandomSceneSettings settings;
    for (const std::uint64_t seed : {3U, 14U, 15U}) {
        settings.scale = 1;
        const Scene scene = random_scene(seed, settings);
        const auto rays = mixed_rays(seed, 1);
        const Answers expected = answers(*make_wide_bvh(scene), rays);
        for (const double scale : {0x1p-20, 0x1p20, 0x1p-200, 0x1p200}) {
            settings.scale = scale;
            const Scene copy = random_scene(seed, settings);
            auto copied_rays = rays;
            for (QueryRay& query : copied_rays) {
                query.ray.origin = scale * query.ray.origin;
                query.ray.t_min *= scale;
                query.ray.t_max *= scale;
                query.ray.origin_error *= scale;
            }
            const auto index = make_wide_bvh(copy);
            expect_like_brute_force(copy, *index, copied_rays, "scale " + std::to_string(scale));
            if (scale < 0x1p-100 || scale > 0x1p100)
                continue; // squares of squares lose digits there
            const Answers found = answers(*index, copied_rays);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_EQ(found.hits[i].t, scale * expected.hits[i].t) << scale;
                ASSERT_EQ(found.hits[i].face, expected.hits[i].face) << scale;
            }
            EXPECT_EQ(found.hit_counts.tests, expected.hit_counts.tests) << scale;
        }
    }
}

TEST(WideBvh, GivesTheSameBitsWithEveryInstructionSet) {
    RandomSceneSettings settings;
    settings.items = 60;
    settings.glass = true;
    const Scene scene = random_scene(7, settings);
    const auto rays = mixed_rays(7, 1);
    const auto index = make_wide_bvh(scene);
    const Answers expected = answers(*index, rays);
    for (const std::string& level : simd_levels()) {
        ASSERT_TRUE(limit_simd(level));
        expect_same(answers(*index, rays), expected, rays, level);
    }
    EXPECT_TRUE(limit_simd(""));
}

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

TEST(WideBvh, HoldsSubscenesNestedTenThousandDeep) {
    Scene scene;
    constexpr std::uint32_t levels = 10'000;
    scene.subscenes.resize(levels);
    const auto call = [](std::uint32_t subscene) {
        SubsceneCall result;
        result.subscene = SubsceneId{subscene};
        result.to_parent = translation({0, 0, 0.5});
        result.from_parent = *inverse(result.to_parent);
        return result;
    };
    for (std::uint32_t i = 1; i < levels; ++i) {
        scene.subscenes[i].calls.push_back(call(i - 1));
        scene.subscenes[i].items.push_back({.kind = ItemKind::subscene_call});
    }
    scene.subscenes[0].spheres.push_back({{0, 0, 0}, 1});
    scene.subscenes[0].items.push_back({.kind = ItemKind::sphere});
    scene.geometry.calls.push_back(call(levels - 1));
    scene.geometry.items.push_back({.kind = ItemKind::subscene_call});
    number_primitives(scene);
    QueryRay query;
    query.ray.direction = {0, 0, 1};
    const std::vector<QueryRay> rays(2, query);
    const auto index = make_wide_bvh(scene);
    expect_like_brute_force(scene, *index, rays, "nested");
    EXPECT_EQ(answers(*index, rays).hits[0].t, 4999);
}

TEST(WideBvh, TakesScenesOfNothingOrAlmostNothing) {
    Scene scene;
    const auto rays = mixed_rays(2, 1);
    number_primitives(scene);
    expect_like_brute_force(scene, *make_wide_bvh(scene), rays, "empty");

    scene.subscenes.resize(1);
    scene.geometry.calls.push_back({});
    scene.geometry.items.push_back({.kind = ItemKind::subscene_call});
    number_primitives(scene);
    expect_like_brute_force(scene, *make_wide_bvh(scene), rays, "empty subscene");

    scene.geometry.triangles.push_back({{Vec3{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}});
    scene.geometry.items.push_back({.kind = ItemKind::triangle});
    number_primitives(scene);
    expect_like_brute_force(scene, *make_wide_bvh(scene), rays, "one triangle");
}

TEST(WideBvh, AnswersRaysThatGoNowhere) {
    const Scene scene = random_scene(4, {});
    std::vector<QueryRay> rays(3);
    rays[1].ray.direction = {1e-200, 0, 0};
    rays[2].ray.direction = {0, 1e200, 1e190};
    expect_like_brute_force(scene, *make_wide_bvh(scene), rays, "strange directions");
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

TEST(WideBvh, CanBeInterruptedAndTellsHowFarItIs) {
    const Scene scene = random_scene(1, {});
    double last = 0;
    make_wide_bvh(scene, [&](double done) {
        EXPECT_GE(done, last);
        last = done;
    });
    EXPECT_EQ(last, 1);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(make_wide_bvh(scene, {}, &cancel), Cancelled);
}

} // namespace
} // namespace vera
