// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/brute_force.h"
#include "vera/accel/grid_tree.h"
#include "vera/accel/simd_level.h"

#include <cstring>
#include <string>

#include "random_scene.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::coherent_rays;
using testing::random_rays;
using testing::random_scene;
using testing::RandomSceneSettings;
using testing::rays_from_hits;

struct Answers {
    std::vector<Hit> hits;
    std::vector<Color> transmitted;
    QueryCounts hit_counts;
    QueryCounts transmittance_counts;
};

Answers answers(const RayIndex& index, const std::vector<QueryRay>& rays) {
    Answers result;
    result.hits.resize(rays.size());
    result.transmitted.resize(rays.size());
    index.nearest_hits(rays, result.hits, result.hit_counts);
    index.transmittances(rays, result.transmitted, result.transmittance_counts);
    return result;
}

bool same_bits(double a, double b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

void expect_same(
    const Answers& found,
    const Answers& expected,
    const std::vector<QueryRay>& rays,
    const std::string& what) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Hit& a = found.hits[i];
        const Hit& b = expected.hits[i];
        const Color& c = found.transmitted[i];
        const Color& d = expected.transmitted[i];
        const Ray& ray = rays[i].ray;
        ASSERT_TRUE(same_bits(a.t, b.t) && a.face == b.face)
            << what << ", ray " << i << ": found t " << a.t << " of " << a.face.primitive << "."
            << a.face.piece << ", expected " << b.t << " of " << b.face.primitive << "."
            << b.face.piece << "\norigin " << ray.origin.x << " " << ray.origin.y << " "
            << ray.origin.z << " direction " << ray.direction.x << " " << ray.direction.y << " "
            << ray.direction.z << " from " << ray.t_min << " to " << ray.t_max << " start "
            << rays[i].start.primitive << "." << rays[i].start.piece;
        ASSERT_TRUE(same_bits(c.r, d.r) && same_bits(c.g, d.g) && same_bits(c.b, d.b))
            << what << ", ray " << i << ": found transmittance " << c.r << " " << c.g << " " << c.b
            << ", expected " << d.r << " " << d.g << " " << d.b;
    }
}

void expect_grid_like_brute_force(
    const Scene& scene,
    const std::vector<QueryRay>& rays,
    const GridSettings& settings,
    const std::string& what) {
    const auto brute = make_brute_force(scene);
    const auto grid = make_grid_tree(scene, settings);
    const Answers found = answers(*grid, rays);
    const Answers expected = answers(*brute, rays);
    expect_same(found, expected, rays, what);
    const auto next_rays = rays_from_hits(1, rays, expected.hits);
    expect_same(
        answers(*grid, next_rays), answers(*brute, next_rays), next_rays, what + ", from hits");
    EXPECT_LE(found.hit_counts.tests, expected.hit_counts.tests) << what;
}

TEST(GridTree, AgreesWithBruteForceOnEveryBit) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        RandomSceneSettings settings;
        settings.items = 1 + seed % 50;
        settings.glass = seed % 2 == 0;
        GridSettings grid;
        grid.crowd = seed % 3 == 0 ? 3 : 16;
        grid.density = seed % 5 == 0 ? 20 : 2;
        const Scene scene = random_scene(seed, settings);
        auto rays = random_rays(seed, 1000, 1);
        const auto more = coherent_rays(seed, 1000, 1);
        rays.insert(rays.end(), more.begin(), more.end());
        expect_grid_like_brute_force(scene, rays, grid, "seed " + std::to_string(seed));
        if (HasFatalFailure() || HasNonfatalFailure())
            return;
    }
}

} // namespace
} // namespace vera
