// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/mesh_index.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera::testing {

using MeshPoint = std::array<float, 3>;

/// The memory that a MeshIndex looks at.
struct SampleMesh {
    std::vector<MeshPoint> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;

    MeshSpans spans() const { return {vertices, triangles}; }

    void add_triangle(const MeshPoint& a, const MeshPoint& b, const MeshPoint& c);
};

/// Triangles whose corners have few coordinates, so that many share corners, edges and planes,
/// overlap, coincide, or are slivers, lines and points.
SampleMesh random_mesh(std::uint64_t seed, std::size_t triangles);

/// A copy whose vertices are factor * vertex + offset, rounded.
SampleMesh scaled_and_shifted(SampleMesh mesh, float factor, float offset);

/// Triangles upon each other, nearer to each other than single precision tells apart where rays
/// meet them.
SampleMesh close_layers(std::uint64_t seed, std::size_t layers);

/// The triangles of random meshes as small and as large as single precision allows, mixed.
SampleMesh mixed_sizes(std::uint64_t seed, std::size_t triangles);

/// Random triangles, some of which are far smaller than the others and lie near a place where these
/// have few coordinates.
SampleMesh small_triangles_beside_large(std::uint64_t seed, std::size_t small);

/// A copy in which some vertices have coordinates that are no numbers, or infinite.
SampleMesh with_broken_vertices(SampleMesh mesh, std::uint64_t seed);

/// A cube from -1 to 1, closed; each of its 12 triangles is cut into 4, so many times.
SampleMesh cube(std::size_t cuts);

/// An octahedron whose triangles are cut into 4, so many times, with all corners at distance 1.
SampleMesh sphere(std::size_t cuts);

/// The same with corners at distances from 0.5 to 1.
SampleMesh rough_sphere(std::size_t cuts, std::uint64_t seed);

/// Rays to and from the mesh's corners, along its edges, in its planes and across, of every length;
/// some with numbers that are none.
std::vector<MeshRay>
random_mesh_rays(std::uint64_t seed, const SampleMesh& mesh, std::size_t count);

/// Rays of which each 16 go from one place, or nearly, in one direction, or nearly; now and then
/// one among them differs.
std::vector<MeshRay>
coherent_mesh_rays(std::uint64_t seed, const SampleMesh& mesh, std::size_t count);

/// Rays of which each 96 run to one place, or in one direction, or nearly: those of one light. They
/// start at all places, or each 16 in a small square, and of half of the lights begin and end
/// anywhere.
std::vector<MeshRay> rays_of_lights(std::uint64_t seed, const SampleMesh& mesh, std::size_t count);

/// Copies of a ray that begin and end before, at and behind the t.
std::vector<MeshRay> rays_cut_at(const MeshRay& ray, float t);

} // namespace vera::testing
