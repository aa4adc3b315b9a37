// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/accel/primitive_hit.h"

#include <array>
#include <cstdint>
#include <vector>

#include "accel/random_scene.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

TEST(PrimitiveHit, IsWhatAnIndexAnswersWhereThePrimitiveIsMetFirst) {
    int found = 0;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        const Scene scene =
            testing::random_scene(seed, {.items = 20, .scale = seed % 3 == 0 ? 1e4 : 1});
        const auto index = make_brute_force(scene);
        for (const QueryRay& query : testing::random_rays(seed, 150, seed % 3 == 0 ? 1e4 : 1)) {
            std::array<Hit, 1> expected;
            QueryCounts counts;
            const QueryRay from_nowhere = {query.ray, {}};
            index->nearest_hits(std::array{from_nowhere}, expected, counts);
            if (!expected[0].found())
                continue;
            ++found;
            EXPECT_EQ(primitive_hit(scene, query.ray, expected[0].face.primitive), expected[0]);
        }
    }
    EXPECT_GT(found, 500);
}

TEST(PrimitiveHit, IsWhatAnIndexAnswersOfARayThatStartsOnAFaceAsWell) {
    int found = 0;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        const Scene scene = testing::random_scene(seed, {.items = 20});
        const auto index = make_brute_force(scene);
        const std::vector<QueryRay> rays = testing::random_rays(seed, 150, 1);
        std::vector<Hit> hits(rays.size());
        QueryCounts counts;
        index->nearest_hits(rays, hits, counts);
        for (const QueryRay& query : testing::rays_from_hits(seed, rays, hits)) {
            // None before the first, nor the face that the ray starts on.
            std::array<Hit, 1> expected;
            index->nearest_hits(std::array{query}, expected, counts);
            if (expected[0].found()) {
                EXPECT_EQ(primitive_hit(scene, query, expected[0].face.primitive), expected[0]);
                ++found;
            } else if (query.start.primitive != no_primitive) {
                EXPECT_FALSE(primitive_hit(scene, query, query.start.primitive).found());
            }
        }
    }
    EXPECT_GT(found, 300);
}

TEST(PrimitiveHit, MeetsNoPrimitiveBeforeTheFirst) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        const Scene scene = testing::random_scene(seed, {.items = 12});
        const auto index = make_brute_force(scene);
        for (const QueryRay& query : testing::random_rays(seed, 60, 1)) {
            std::array<Hit, 1> expected;
            QueryCounts counts;
            const QueryRay from_nowhere = {query.ray, {}};
            index->nearest_hits(std::array{from_nowhere}, expected, counts);
            Hit first;
            for (std::uint64_t i = 0; i < scene.geometry.primitive_count; ++i)
                if (const Hit hit = primitive_hit(scene, query.ray, i); hit.t < first.t)
                    first = hit;
            // Of those that coincide the first of the text is the answer, which may lie behind.
            EXPECT_EQ(first.found(), expected[0].found());
            if (first.found()) {
                EXPECT_LE(first.t, expected[0].t);
                EXPECT_NEAR(first.t, expected[0].t, 1e-9);
            }
        }
    }
}

} // namespace
} // namespace vera
