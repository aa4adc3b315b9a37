// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/base/available_memory.h"
#include "vera/theory/primitive_query_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "accel/index_answers.h"
#include "accel/random_scene.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::Answers;
using testing::answers;

/// As random and coherent rays, and as many that sweeps can hold.
std::vector<QueryRay> some_rays(std::uint64_t seed, double scale = 1) {
    auto rays = testing::mixed_rays(seed, scale);
    auto held = testing::mixed_rays(seed + 1000, scale);
    for (QueryRay& query : held) {
        query.ray.t_min = std::max(query.ray.t_min, 0.0);
        rays.push_back(query);
    }
    return rays;
}

/// On the rays, and on rays that start where these hit.
void expect_like_brute_force(
    const Scene& scene,
    const PrimitiveQueryIndex& index,
    const std::vector<QueryRay>& rays,
    const std::string& what) {
    const auto brute = make_brute_force(scene);
    const Answers expected = answers(*brute, rays);
    testing::expect_same(answers(index, rays), expected, rays, what);
    const auto next = testing::rays_from_hits(1, rays, expected.hits);
    testing::expect_same(answers(index, next), answers(*brute, next), next, what + ", from hits");
}

TEST(PrimitiveQueryIndex, AgreesWithBruteForceOnEveryBit) {
    std::uint64_t swept = 0;
    std::uint64_t apart = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        testing::RandomSceneSettings settings;
        settings.items = 1 + 2 * seed;
        settings.glass = seed % 2 == 0;
        const Scene scene = testing::random_scene(seed, settings);
        PrimitiveQuerySettings query_settings;
        query_settings.queries = std::array{
            RayQueries::automatic,
            RayQueries::sweep,
            RayQueries::groups,
            RayQueries::nested,
            RayQueries::trees}[seed % 5];
        if (seed % 6 == 5)
            query_settings.level = 3;
        const PrimitiveQueryIndex index(scene, query_settings);
        expect_like_brute_force(scene, index, some_rays(seed), "seed " + std::to_string(seed));
        if (HasFatalFailure())
            return;
        for (const GenerationCounts& generation : index.generations()) {
            swept += generation.swept;
            apart += generation.apart;
        }
    }
    EXPECT_GT(swept, 50000U);
    EXPECT_LT(apart, swept / 100);
}

TEST(PrimitiveQueryIndex, AgreesInAnyUnitOfLength) {
    testing::RandomSceneSettings settings;
    for (const double scale : {0x1p-20, 0x1p20, 0x1p-200, 0x1p200}) {
        settings.scale = scale;
        const Scene scene = testing::random_scene(14, settings);
        const PrimitiveQueryIndex index(scene);
        expect_like_brute_force(scene, index, some_rays(14, scale), std::to_string(scale));
    }
}

TEST(PrimitiveQueryIndex, AgreesAtPlacesWithinALargeRoom) {
    const Scene scene = testing::detail_in_a_room();
    const PrimitiveQueryIndex index(scene);
    std::vector<QueryRay> rays = testing::coherent_rays(5, 40, 0.05);
    const auto brute = make_brute_force(scene);
    testing::expect_same(answers(index, rays), answers(*brute, rays), rays, "room");
}

TEST(PrimitiveQueryIndex, FindsTheFirstInTheTextOfManyCoincidentFaces) {
    Scene scene;
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
    const PrimitiveQueryIndex index(scene);
    expect_like_brute_force(scene, index, rays, "coincident");
    EXPECT_EQ(answers(index, rays).hits.back().face, (FaceId{0, 0}));
}

TEST(PrimitiveQueryIndex, AnswersNothingInAnEmptyScene) {
    Scene scene;
    number_primitives(scene);
    const PrimitiveQueryIndex index(scene);
    expect_like_brute_force(scene, index, some_rays(3), "empty");
}

TEST(PrimitiveQueryIndex, CountsNoCrossingsOfRaysFromOnePointOrToOne) {
    const Scene scene = testing::random_scene(4, {});
    const PrimitiveQueryIndex index(scene, {.queries = RayQueries::sweep});
    const Vec3 eye = {0.3, -0.2, 9.1};
    std::vector<QueryRay> from_eye;
    std::vector<QueryRay> to_light;
    for (int i = 0; i < 900; ++i) {
        const Vec3 place = {0.1 * (i % 30) - 1.5, 0.1 * (i / 30) - 1.5, 0.05 * (i % 7)};
        QueryRay query;
        query.ray.origin = eye;
        query.ray.direction = place - eye;
        from_eye.push_back(query);
        query.ray.origin = place;
        query.ray.direction = eye - place;
        query.ray.t_max = 1 - 1e-9;
        to_light.push_back(query);
    }
    QueryCounts counts;
    std::vector<Hit> hits(from_eye.size());
    index.nearest_hits(from_eye, hits, counts);
    std::vector<Color> transmitted(to_light.size());
    index.transmittances(to_light, transmitted, counts);
    const auto generations = index.generations();
    ASSERT_EQ(generations.size(), 2U);
    EXPECT_TRUE(generations[1].are_shadow_rays);
    for (const GenerationCounts& generation : generations) {
        EXPECT_EQ(generation.rays, 900U);
        EXPECT_GT(generation.sweeps.pairs, 300'000U);
        EXPECT_EQ(generation.sweeps.x_swaps + generation.sweeps.y_swaps, 0U);
        EXPECT_GT(generation.sweeps.reports, 100U);
    }
}

/// What generations take of which one asks what it meets, and the next what it lets through: rays
/// of few points, and those that start where these hit.
std::vector<GenerationCounts> generations_by(RayQueries queries, const Scene& scene) {
    const PrimitiveQueryIndex index(scene, {.queries = queries});
    std::vector<QueryRay> rays = testing::coherent_rays(4, 900, 1);
    QueryCounts counts;
    std::vector<Hit> hits(rays.size());
    index.nearest_hits(rays, hits, counts);
    const auto next = testing::rays_from_hits(1, rays, hits);
    rays.insert(rays.end(), next.begin(), next.end());
    std::vector<Color> transmitted(rays.size());
    index.transmittances(rays, transmitted, counts);
    return index.generations();
}

TEST(PrimitiveQueryIndex, TestsWhatFacesTellAndWhereRaysBeginHoweverItAsks) {
    testing::RandomSceneSettings settings;
    settings.items = 30;
    settings.glass = true;
    const Scene scene = testing::random_scene(4, settings);
    const auto by_sweep = generations_by(RayQueries::sweep, scene);
    ASSERT_EQ(by_sweep.size(), 2U);
    for (const auto& [queries, name] :
         {std::pair{RayQueries::automatic, "auto"},
          std::pair{RayQueries::sweep, "sweep"},
          std::pair{RayQueries::groups, "groups"},
          std::pair{RayQueries::nested, "nested"},
          std::pair{RayQueries::trees, "trees"}}) {
        const auto generations = generations_by(queries, scene);
        ASSERT_EQ(generations.size(), by_sweep.size());
        for (std::size_t i = 0; i < generations.size(); ++i) {
            const GenerationCounts& generation = generations[i];
            EXPECT_EQ(generation.apart, 0U);
            EXPECT_GT(generation.begun_within, 50U);
            EXPECT_GT(generation.reports(), 500U);
            EXPECT_EQ(generation.tests, generation.reports() + generation.begun_within) << name;
            EXPECT_EQ(generation.reports(), by_sweep[i].reports()) << name;
            // All pairs are in one sweep, or some of them are, or none is.
            const std::uint64_t pairs = generation.sweeps.pairs;
            const std::uint64_t of_one_sweep = by_sweep[i].sweeps.pairs;
            EXPECT_GT(of_one_sweep, 100'000U);
            EXPECT_LE(pairs, of_one_sweep) << name;
            EXPECT_EQ(pairs == of_one_sweep, queries == RayQueries::sweep) << name;
            EXPECT_EQ(pairs == 0, queries == RayQueries::trees) << name;
        }
    }
}

TEST(PrimitiveQueryIndex, RefusesWhatMemoryDoesNotHoldWithTheFigures) {
    const Scene scene = testing::random_scene(4, {});
    QueryRay query;
    query.ray.origin = {0, 0, 9};
    query.ray.direction = {0.1, 0.2, -1};
    const std::vector<QueryRay> rays(300'000, query);
    std::vector<Hit> hits(rays.size());
    for (const auto& [queries, what] :
         {std::pair{RayQueries::sweep, "a sweep through "},
          std::pair{RayQueries::nested, "nested sweeps of 300000 rays takes about "},
          std::pair{RayQueries::trees, "nesting trees of 300000 rays among "}}) {
        const PrimitiveQueryIndex index(scene, {.queries = queries});
        const MemoryLimit little(1);
        QueryCounts counts;
        try {
            index.nearest_hits(rays, hits, counts);
            FAIL() << what;
        } catch (const std::runtime_error& error) {
            EXPECT_THAT(error.what(), ::testing::StartsWith(what));
            EXPECT_THAT(error.what(), ::testing::HasSubstr("are available: "));
        }
    }
}

TEST(PrimitiveQueryIndex, CanBeStopped) {
    const Scene scene = testing::random_scene(4, {});
    CancelFlag cancel;
    const PrimitiveQueryIndex index(scene, {.cancel = &cancel});
    const auto rays = testing::mixed_rays(1, 1);
    std::vector<Hit> hits(rays.size());
    QueryCounts counts;
    cancel.raise();
    EXPECT_THROW(index.nearest_hits(rays, hits, counts), Cancelled);
}

} // namespace
} // namespace vera
