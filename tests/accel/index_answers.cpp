// SPDX-License-Identifier: Apache-2.0
#include "index_answers.h"

#include "vera/accel/brute_force.h"

#include <bit>
#include <cstdint>

#include "random_scene.h"
#include <gtest/gtest.h>

namespace vera::testing {

Answers answers(const RayIndex& index, const std::vector<QueryRay>& rays) {
    Answers result;
    result.hits.resize(rays.size());
    result.transmitted.resize(rays.size());
    index.nearest_hits(rays, result.hits, result.hit_counts);
    index.transmittances(rays, result.transmitted, result.transmittance_counts);
    return result;
}

namespace {

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

} // namespace

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

void expect_like_brute_force(
    const Scene& scene,
    const RayIndex& index,
    const std::vector<QueryRay>& rays,
    const std::string& what) {
    const auto brute = make_brute_force(scene);
    const Answers found = answers(index, rays);
    const Answers expected = answers(*brute, rays);
    expect_same(found, expected, rays, what);
    const auto next_rays = rays_from_hits(1, rays, expected.hits);
    expect_same(
        answers(index, next_rays), answers(*brute, next_rays), next_rays, what + ", from hits");
    EXPECT_LE(found.hit_counts.tests, expected.hit_counts.tests) << what;
}

std::vector<QueryRay> mixed_rays(std::uint64_t seed, double scale) {
    auto rays = random_rays(seed, 300, scale);
    const auto more = coherent_rays(seed, 300, scale);
    rays.insert(rays.end(), more.begin(), more.end());
    return rays;
}

Scene detail_in_a_room() {
    Scene scene;
    const auto add = [&](Vec3 a, Vec3 b, Vec3 c) {
        scene.geometry.items.push_back(
            {.kind = ItemKind::triangle,
             .index = static_cast<std::uint32_t>(scene.geometry.triangles.size())});
        scene.geometry.triangles.push_back({{a, b, c}});
    };
    add({-100, -100, -100}, {100, -100, -100}, {100, -100, 100});
    add({-100, -100, 100}, {-100, 100, -100}, {-100, 100, 100});
    for (int i = 0; i < 100; ++i)
        for (int j = 0; j < 100; ++j) {
            const Vec3 p = {0.001 * i, 0.001 * j, 0.0001 * ((i * i + j * j) % 10)};
            add(p, p + Vec3{0.001, 0, 0}, p + Vec3{0, 0.001, 0});
        }
    number_primitives(scene);
    return scene;
}

} // namespace vera::testing
