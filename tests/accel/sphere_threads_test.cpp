// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/sphere_index.h"
#include "vera/base/parallel.h"

#include <span>
#include <thread>
#include <vector>

#include "sample_spheres.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::ball_of_balls;
using testing::coherent_mesh_rays;
using testing::places_about;
using testing::random_mesh_rays;
using testing::random_spheres;
using testing::SampleSpheres;

std::vector<SphereHit> nearest_hits(const SphereIndex& index, const std::vector<IndexRay>& rays) {
    std::vector<SphereHit> hits(rays.size());
    index.nearest_hits(rays, hits);
    return hits;
}

TEST(SphereIndex, IsTheSameWhateverTheNumberOfThreads) {
    for (const SampleSpheres& spheres : {ball_of_balls(60), random_spheres(2, 5000)})
        for (const IndexQuality quality : {IndexQuality::usual, IndexQuality::high}) {
            const auto rays = random_mesh_rays(1, places_about(spheres), 300);
            const SphereIndex expected(spheres, quality);
            for (const std::size_t threads : {1U, 2U, 7U}) {
                const ThreadLimit limit(threads);
                const SphereIndex index(spheres, quality);
                EXPECT_EQ(index.statistics(), expected.statistics()) << threads;
                EXPECT_EQ(nearest_hits(index, rays), nearest_hits(expected, rays)) << threads;
            }
        }
}

TEST(SphereIndex, AnswersManyThreadsAtOnceAsItAnswersOne) {
    const SampleSpheres spheres = ball_of_balls(40);
    const SphereIndex index(spheres);
    const auto rays = coherent_mesh_rays(1, places_about(spheres), 2000);
    const std::vector<SphereHit> expected = nearest_hits(index, rays);
    constexpr std::size_t threads = 8;
    std::vector<std::vector<SphereHit>> found(threads);
    std::vector<std::vector<std::uint8_t>> met(threads);
    std::vector<std::thread> running;
    for (std::size_t i = 0; i < threads; ++i)
        running.emplace_back([&, i] {
            found[i] = nearest_hits(index, rays);
            met[i].resize(rays.size());
            index.meet_any(rays, met[i]);
        });
    for (std::thread& thread : running)
        thread.join();
    for (std::size_t i = 0; i < threads; ++i) {
        EXPECT_EQ(found[i], expected) << "thread " << i;
        for (std::size_t ray = 0; ray < rays.size(); ++ray)
            ASSERT_EQ(met[i][ray] == 1, expected[ray].found()) << "thread " << i;
    }
}

TEST(SphereIndex, IsNotMadeWhenItIsCancelled) {
    const SampleSpheres spheres = random_spheres(3, 1000);
    for (const IndexQuality quality : {IndexQuality::usual, IndexQuality::high}) {
        CancelFlag cancel;
        EXPECT_EQ(SphereIndex(spheres, quality, &cancel).statistics().spheres, 1000U);
        cancel.raise();
        EXPECT_THROW(SphereIndex(spheres, quality, &cancel), Cancelled);
    }
}

} // namespace
} // namespace vera
