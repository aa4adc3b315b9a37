// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/mesh_index.h"
#include "vera/base/parallel.h"

#include <algorithm>
#include <thread>
#include <vector>

#include "sample_mesh.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::coherent_mesh_rays;
using testing::random_mesh;
using testing::random_mesh_rays;
using testing::rough_sphere;
using testing::SampleMesh;

constexpr MeshIndexQuality both_qualities[] = {MeshIndexQuality::usual, MeshIndexQuality::high};

std::vector<MeshHit> nearest_hits(const MeshIndex& index, const std::vector<MeshRay>& rays) {
    std::vector<MeshHit> hits(rays.size());
    index.nearest_hits(rays, hits);
    return hits;
}

TEST(MeshIndex, IsTheSameWhateverTheNumberOfThreads) {
    for (const SampleMesh& mesh : {rough_sphere(5, 1), random_mesh(2, 3000)})
        for (const MeshIndexQuality quality : both_qualities) {
            const auto rays = random_mesh_rays(1, mesh, 500);
            const MeshIndex expected(mesh.spans(), quality);
            for (const std::size_t threads : {1U, 2U, 7U}) {
                const ThreadLimit limit(threads);
                const MeshIndex index(mesh.spans(), quality);
                EXPECT_EQ(index.statistics(), expected.statistics()) << threads;
                EXPECT_EQ(nearest_hits(index, rays), nearest_hits(expected, rays)) << threads;
            }
        }
}

TEST(MeshIndex, AnswersManyThreadsAtOnceAsItAnswersOne) {
    const SampleMesh mesh = rough_sphere(4, 1);
    const MeshIndex index(mesh.spans());
    const auto rays = coherent_mesh_rays(1, mesh, 2000);
    const std::vector<MeshHit> expected = nearest_hits(index, rays);
    constexpr std::size_t threads = 8;
    std::vector<std::vector<MeshHit>> found(threads);
    std::vector<std::size_t> wrong(threads);
    std::vector<std::thread> running;
    for (std::size_t i = 0; i < threads; ++i)
        running.emplace_back([&, i] {
            found[i] = nearest_hits(index, rays);
            std::vector<std::uint8_t> met(rays.size());
            index.meet_any(rays, met);
            for (std::size_t ray = i; ray < rays.size(); ray += threads) {
                const auto all = index.all_hits(rays[ray]);
                const bool right = index.nearest_hit(rays[ray]) == expected[ray]
                    && index.meets_any(rays[ray]) == expected[ray].found()
                    && (met[ray] == 1) == expected[ray].found()
                    && all.empty() != expected[ray].found();
                wrong[i] += right ? 0 : 1;
            }
        });
    for (std::thread& thread : running)
        thread.join();
    for (std::size_t i = 0; i < threads; ++i) {
        EXPECT_EQ(found[i], expected) << "thread " << i;
        EXPECT_EQ(wrong[i], 0U) << "thread " << i;
    }
}

TEST(MeshIndex, AnswersPartsOfASpanFromThreads) {
    const SampleMesh mesh = rough_sphere(4, 2);
    const MeshIndex index(mesh.spans());
    const auto rays = random_mesh_rays(1, mesh, 3000);
    std::vector<MeshHit> hits(rays.size());
    parallel_ranges(rays.size(), 37, [&](std::size_t first, std::size_t last) {
        index.nearest_hits(
            std::span(rays).subspan(first, last - first),
            std::span(hits).subspan(first, last - first));
    });
    EXPECT_EQ(hits, nearest_hits(index, rays));
}

TEST(MeshIndex, IsNotMadeWhenItIsCancelled) {
    const SampleMesh mesh = random_mesh(3, 20'000);
    CancelFlag cancel;
    EXPECT_EQ(
        MeshIndex(mesh.spans(), MeshIndexQuality::usual, &cancel).statistics().triangles, 20'000U);
    for (const MeshIndexQuality quality : both_qualities) {
        CancelFlag raised;
        raised.raise();
        EXPECT_THROW(MeshIndex(mesh.spans(), quality, &raised), Cancelled);
        // Now while it is made, sooner or later.
        for (const int microseconds : {0, 100, 1000, 5000}) {
            CancelFlag flag;
            std::thread other([&] {
                std::this_thread::sleep_for(std::chrono::microseconds(microseconds));
                flag.raise();
            });
            try {
                const MeshIndex index(mesh.spans(), quality, &flag);
            } catch (const Cancelled&) { // NOLINT(bugprone-empty-catch)
            }
            other.join();
        }
    }
}

} // namespace
} // namespace vera
