// SPDX-License-Identifier: Apache-2.0
// No ray leaves a closed mesh, or goes through it, unseen.
#include "vera/accel/mesh_index.h"

#include <set>
#include <string>
#include <utility>

#include "sample_mesh.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::cube;
using testing::MeshPoint;
using testing::rough_sphere;
using testing::SampleMesh;
using testing::scaled_and_shifted;
using testing::sphere;

/// All corners, and the middles of all edges as single precision has them.
std::vector<MeshPoint> corners_and_middles(const SampleMesh& mesh) {
    std::vector<MeshPoint> places = mesh.vertices;
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& [a, b, c] : mesh.triangles)
        for (const auto& edge : {std::minmax(a, b), std::minmax(b, c), std::minmax(c, a)})
            if (edges.insert(edge).second) {
                MeshPoint middle;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    middle[axis] =
                        0.5F * (mesh.vertices[edge.first][axis] + mesh.vertices[edge.second][axis]);
                places.push_back(middle);
            }
    return places;
}

MeshRay ray_from_to(const MeshPoint& origin, const MeshPoint& target) {
    MeshRay ray = {.origin = origin};
    for (std::size_t axis = 0; axis < 3; ++axis)
        ray.direction[axis] = target[axis] - origin[axis];
    return ray;
}

/// A place on the line from inside through the target, beyond it.
MeshPoint beyond(const MeshPoint& inside, const MeshPoint& target, float factor) {
    MeshPoint place;
    for (std::size_t axis = 0; axis < 3; ++axis)
        place[axis] = inside[axis] + factor * (target[axis] - inside[axis]);
    return place;
}

/// Asks about the rays alone and together, in every way: each must meet the mesh.
void expect_all_meet(
    const MeshIndex& index, const std::vector<MeshRay>& rays, const std::string& what) {
    std::vector<MeshHit> hits(rays.size());
    std::vector<std::uint8_t> met(rays.size());
    index.nearest_hits(rays, hits);
    index.meet_any(rays, met);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(hits[i].found()) << what << ", ray " << i;
        ASSERT_EQ(met[i], 1) << what << ", ray " << i;
        ASSERT_TRUE(index.nearest_hit(rays[i]).found()) << what << ", ray " << i;
        ASSERT_TRUE(index.meets_any(rays[i])) << what << ", ray " << i;
        ASSERT_FALSE(index.all_hits(rays[i]).empty()) << what << ", ray " << i;
    }
}

/// The mesh is closed, and all rays from the origin leave it at a distance of 0.4 or more.
void expect_watertight(const SampleMesh& around_origin, const std::string& what) {
    for (const auto& [factor, offset] : std::initializer_list<std::pair<float, float>>{
             {1, 0},
             {0x1p60F, 0},
             {0x1p-60F, 0},
             {1e-30F, 0},
             {1e30F, 0},
             {1, 0.3F},
             {1000, 1e6F}}) {
        const SampleMesh mesh = scaled_and_shifted(around_origin, factor, offset);
        const MeshIndex index(mesh.spans());
        const std::vector<MeshPoint> targets = corners_and_middles(mesh);
        for (const MeshPoint& place :
             {MeshPoint{0, 0, 0}, MeshPoint{0.1F, 0.07F, -0.13F}, MeshPoint{0, 0.25F, 0}}) {
            MeshPoint inside;
            for (std::size_t axis = 0; axis < 3; ++axis)
                inside[axis] = factor * place[axis] + offset;
            std::vector<MeshRay> outward;
            std::vector<MeshRay> inward;
            for (const MeshPoint& target : targets) {
                outward.push_back(ray_from_to(inside, target));
                inward.push_back(ray_from_to(beyond(inside, target, 2.5F), target));
                inward.push_back(ray_from_to(beyond(inside, target, 40), inside));
            }
            const std::string where =
                what + " * " + std::to_string(factor) + " + " + std::to_string(offset);
            expect_all_meet(index, outward, where + ", outward");
            expect_all_meet(index, inward, where + ", inward");
            if (::testing::Test::HasFailure())
                return;
        }
    }
}

TEST(MeshIndex, IsWatertightAboutASphere) {
    expect_watertight(sphere(4), "sphere");
}

TEST(MeshIndex, IsWatertightAboutARoughSphere) {
    expect_watertight(rough_sphere(3, 1), "rough sphere");
}

TEST(MeshIndex, IsWatertightAboutACube) {
    expect_watertight(cube(3), "cube");
}

} // namespace
} // namespace vera
