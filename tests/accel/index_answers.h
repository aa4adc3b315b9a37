// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/scene/scene.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vera::testing {

/// All that an index says about some rays.
struct Answers {
    std::vector<Hit> hits;
    std::vector<Color> transmitted;
    QueryCounts hit_counts;
    QueryCounts transmittance_counts;
};

Answers answers(const RayIndex& index, const std::vector<QueryRay>& rays);

/// Fails where the answers differ in any bit.
void expect_same(
    const Answers& found,
    const Answers& expected,
    const std::vector<QueryRay>& rays,
    const std::string& what);

/// Fails where the index of the scene does not answer like brute force, on the rays and on rays
/// that start where these hit, or tests more.
void expect_like_brute_force(
    const Scene& scene,
    const RayIndex& index,
    const std::vector<QueryRay>& rays,
    const std::string& what);

/// Random and coherent rays.
std::vector<QueryRay> mixed_rays(std::uint64_t seed, double scale);

/// A ball of many triangles, each 1e-4 of its distance from the middle, in a large room.
Scene detail_in_a_room();

} // namespace vera::testing
