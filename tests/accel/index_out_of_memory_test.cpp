// SPDX-License-Identifier: Apache-2.0
// What a MeshIndex or a SphereIndex leaves behind when memory runs out while it is made: nothing. A
// program of its own, as it replaces operator new.
#include "vera/accel/mesh_index.h"
#include "vera/accel/sphere_index.h"
#include "vera/base/parallel.h"

#include "base/counted_memory.h"
#include "sample_mesh.h"
#include "sample_spheres.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::random_mesh;
using testing::random_spheres;
using testing::SampleMesh;
using testing::SampleSpheres;

/// Memory runs out each time so many blocks later.
template <typename Make>
void expect_nothing_left_behind(std::size_t threads, std::size_t step, const Make& make) {
    const ThreadLimit limit(threads);
    const auto later = [&](std::size_t given) { return given + step; };
    EXPECT_GT(testing::expect_nothing_left_behind(make, later), 5U);
}

/// So many triangles.
void expect_nothing_left_of_mesh(
    std::size_t triangles, MeshIndexQuality quality, std::size_t threads, std::size_t step) {
    const SampleMesh mesh = random_mesh(1, triangles);
    expect_nothing_left_behind(
        threads, step, [&] { const MeshIndex index(mesh.spans(), quality); });
}

TEST(MeshIndex, LeavesNothingBehindWhereverMemoryRunsOut) {
    for (const auto quality : {MeshIndexQuality::usual, MeshIndexQuality::high}) {
        expect_nothing_left_of_mesh(1, quality, 1, 1);
        expect_nothing_left_of_mesh(300, quality, 1, 1);
        expect_nothing_left_of_mesh(10'000, quality, 1, 97);
        expect_nothing_left_of_mesh(10'000, quality, 3, 89);
    }
}

TEST(SphereIndex, LeavesNothingBehindWhereverMemoryRunsOut) {
    for (const auto quality : {IndexQuality::usual, IndexQuality::high}) {
        const SampleSpheres spheres = random_spheres(1, 300);
        expect_nothing_left_behind(1, 1, [&] { const SphereIndex index(spheres, quality); });
        expect_nothing_left_behind(3, 7, [&] { const SphereIndex index(spheres, quality); });
    }
}

} // namespace
} // namespace vera
