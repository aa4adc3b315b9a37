// SPDX-License-Identifier: Apache-2.0
// What every index must do, whatever it is made of.
#include "vera/accel/grid_tree.h"
#include "vera/accel/simd_level.h"
#include "vera/accel/wide_bvh.h"

#include <functional>
#include <memory>
#include <string>

#include "index_answers.h"
#include "random_scene.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::Answers;
using testing::answers;
using testing::expect_like_brute_force;
using testing::expect_same;
using testing::mixed_rays;
using testing::random_scene;
using testing::RandomSceneSettings;

struct IndexKind {
    std::string name;
    std::function<std::unique_ptr<RayIndex>(const Scene&, const Progress&, const CancelFlag*)> make;
};

class EveryIndex : public ::testing::TestWithParam<IndexKind> {
protected:
    static std::unique_ptr<RayIndex>
    make(const Scene& scene, const Progress& progress = {}, const CancelFlag* cancel = nullptr) {
        return GetParam().make(scene, progress, cancel);
    }
};

INSTANTIATE_TEST_SUITE_P(
    Kinds,
    EveryIndex,
    ::testing::Values(
        IndexKind{
            "Grid",
            [](const Scene& scene, const Progress& progress, const CancelFlag* cancel) {
                return make_grid_tree(scene, {}, progress, cancel);
            }},
        IndexKind{
            "Bvh",
            [](const Scene& scene, const Progress& progress, const CancelFlag* cancel) {
                return make_wide_bvh(scene, progress, cancel);
            }}),
    [](const auto& kind) { return kind.param.name; });

TEST_P(EveryIndex, AgreesWithBruteForceOnEveryBit) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        RandomSceneSettings settings;
        settings.items = 1 + 2 * seed;
        settings.glass = seed % 2 == 0;
        const Scene scene = random_scene(seed, settings);
        expect_like_brute_force(
            scene, *make(scene), mixed_rays(seed, 1), "seed " + std::to_string(seed));
        if (HasFatalFailure() || HasNonfatalFailure())
            return;
    }
}

TEST_P(EveryIndex, GivesTheSameBitsWithEveryInstructionSet) {
    RandomSceneSettings settings;
    settings.items = 60;
    settings.glass = true;
    const Scene scene = random_scene(7, settings);
    const auto rays = mixed_rays(7, 1);
    const auto index = make(scene);
    const Answers expected = answers(*index, rays);
    for (const std::string& level : simd_levels()) {
        ASSERT_TRUE(limit_simd(level));
        expect_same(answers(*index, rays), expected, rays, level);
    }
    EXPECT_TRUE(limit_simd(""));
}

TEST_P(EveryIndex, TakesAStartThatNamesNoPieceForNoStart) {
    Scene scene;
    scene.geometry.triangles.push_back({{Vec3{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}});
    scene.geometry.items.push_back({.kind = ItemKind::triangle});
    number_primitives(scene);
    QueryRay query;
    query.ray.origin = {0.25, 0.25, 0};
    query.ray.direction = {0, 0, 1};
    std::vector<QueryRay> rays(2, query);
    rays[0].start = {0, no_piece};
    rays[1].start = {0, 0};
    const auto index = make(scene);
    expect_like_brute_force(scene, *index, rays, "start");
    EXPECT_TRUE(answers(*index, rays).hits[0].found());
    EXPECT_FALSE(answers(*index, rays).hits[1].found());
}

TEST_P(EveryIndex, AgreesInAnyUnitOfLengthAndScalesItsAnswers) {
    RandomSceneSettings settings;
    for (const std::uint64_t seed : {3U, 14U, 15U}) {
        settings.scale = 1;
        const Scene scene = random_scene(seed, settings);
        const auto rays = mixed_rays(seed, 1);
        const Answers expected = answers(*make(scene), rays);
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
            expect_like_brute_force(
                copy, *make(copy), copied_rays, "scale " + std::to_string(scale));
            if (scale < 0x1p-100 || scale > 0x1p100)
                continue; // squares of squares lose digits there
            const Answers found = answers(*make(copy), copied_rays);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_EQ(found.hits[i].t, scale * expected.hits[i].t) << scale;
                ASSERT_EQ(found.hits[i].face, expected.hits[i].face) << scale;
            }
            EXPECT_EQ(found.hit_counts.tests, expected.hit_counts.tests) << scale;
        }
    }
}

TEST_P(EveryIndex, FindsTheFirstInTheTextOfManyCoincidentFaces) {
    Scene scene;
    // Each a little farther than the next, all within rounding of the first.
    for (std::uint32_t i = 0; i < 20; ++i) {
        const double z = 1 - 0x1p-50 * i;
        scene.geometry.triangles.push_back({{Vec3{0, 0, z}, {1, 0, z}, {0, 1, z}}});
        scene.geometry.items.push_back({.kind = ItemKind::triangle, .index = i});
    }
    number_primitives(scene);
    QueryRay query;
    query.ray.origin = {0.25, 0.25, 0};
    query.ray.direction = {0, 0, 1};
    const std::vector<QueryRay> rays(20, query);
    expect_like_brute_force(scene, *make(scene), rays, "coincident");
    const Answers found = answers(*make(scene), rays);
    EXPECT_EQ(found.hits.back().face, (FaceId{0, 0}));
    EXPECT_EQ(found.hits.back().t, 1);
}

TEST_P(EveryIndex, HoldsSubscenesNestedTenThousandDeep) {
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
    expect_like_brute_force(scene, *make(scene), rays, "nested");
    EXPECT_EQ(answers(*make(scene), rays).hits[0].t, 4999);
}

TEST_P(EveryIndex, TakesScenesOfNothingOrAlmostNothing) {
    Scene scene;
    const auto rays = mixed_rays(2, 1);
    number_primitives(scene);
    expect_like_brute_force(scene, *make(scene), rays, "empty");

    scene.subscenes.resize(1);
    scene.geometry.calls.push_back({});
    scene.geometry.items.push_back({.kind = ItemKind::subscene_call});
    number_primitives(scene);
    expect_like_brute_force(scene, *make(scene), rays, "empty subscene");

    for (std::uint32_t i = 0; i < 40; ++i) {
        const double x = i % 8;
        scene.geometry.triangles.push_back({{Vec3{x, 0, 1}, {x + 1, 0, 1}, {x, 1, 1}}});
        scene.geometry.items.push_back({.kind = ItemKind::triangle, .index = i});
    }
    number_primitives(scene);
    expect_like_brute_force(scene, *make(scene), rays, "flat");
}

TEST_P(EveryIndex, AnswersRaysThatGoNowhere) {
    const Scene scene = random_scene(4, {});
    std::vector<QueryRay> rays(3);
    rays[1].ray.direction = {1e-200, 0, 0};
    rays[2].ray.direction = {0, 1e200, 1e190};
    expect_like_brute_force(scene, *make(scene), rays, "strange directions");
}

TEST_P(EveryIndex, CanBeInterruptedAndTellsHowFarItIs) {
    const Scene scene = random_scene(1, {});
    double last = 0;
    make(scene, [&](double done) {
        EXPECT_GE(done, last);
        last = done;
    });
    EXPECT_EQ(last, 1);
    CancelFlag cancel;
    cancel.raise();
    EXPECT_THROW(make(scene, {}, &cancel), Cancelled);
}

} // namespace
} // namespace vera
