// SPDX-License-Identifier: Apache-2.0
// Two triangles with a side in common lie in one plane where the corner of the one beyond that side
// is on the plane of the other: the sign of a determinant, exactly. As triangles that have an area
// span one plane each, all of a patch lie in the same. Neighbours are found round each vertex: of
// the triangles there, the one's next corner is the other's last.
#include "vera/visible/coplanar_patches.h"

#include "vera/base/disjoint_sets.h"
#include "vera/base/long_loop.h"
#include "vera/exact/orientation.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <mutex>
#include <numeric>
#include <span>

namespace vera {

namespace {

/// A triangle with a corner at some vertex, from which it goes round by the other two.
struct TriangleAt {
    std::uint32_t triangle = 0;
    std::uint32_t next = 0; ///< vertices
    std::uint32_t last = 0;
};

TriangleAt triangle_at(const Mesh& mesh, std::uint32_t triangle, std::uint32_t vertex) {
    const auto corners = std::span(mesh.position_indices).subspan(3 * std::size_t{triangle}, 3);
    std::size_t i = 0;
    while (corners[i] != vertex)
        ++i;
    return {triangle, corners[(i + 1) % 3], corners[(i + 2) % 3]};
}

/// Whether all corners of both have the same normal, if any.
bool have_one_normal(const Mesh& mesh, std::uint32_t one, std::uint32_t other) {
    if (mesh.normals.empty())
        return true;
    const auto& indices = mesh.normal_indices.empty() ? mesh.position_indices : mesh.normal_indices;
    const Vec3 normal = mesh.normals[indices[3 * std::size_t{one}]];
    const auto have_it = [&](std::uint32_t triangle) {
        const auto corners = std::span(indices).subspan(3 * std::size_t{triangle}, 3);
        return std::all_of(corners.begin(), corners.end(), [&](std::uint32_t corner) {
            return mesh.normals[corner] == normal;
        });
    };
    return have_it(one) && have_it(other);
}

/// Of two triangles in one plane that have the side a b in common: whether c, a corner of the one,
/// and d, of the other, lie on either side of it. False where one has no area.
bool are_on_either_side(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    // As seen along an axis along which the first one's area is seen.
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (const int side = orientation_along(axis, a, b, c); side != 0)
            return orientation_along(axis, a, b, d) == -side;
    return false;
}

/// Of two triangles at a vertex, of which the one's next corner is the other's last.
bool are_in_one_plane(
    const Mesh& mesh, std::uint32_t vertex, const TriangleAt& one, const TriangleAt& other) {
    const Vec3 a = mesh.positions[vertex];
    const Vec3 b = mesh.positions[one.next];
    const Vec3 c = mesh.positions[one.last];
    const Vec3 d = mesh.positions[other.next];
    return orientation(a, b, c, d) == 0 && are_on_either_side(a, b, c, d)
        && have_one_normal(mesh, one.triangle, other.triangle);
}

/// The triangles at each vertex, one's behind the other's.
struct TrianglesAtVertices {
    std::vector<std::size_t> ends; ///< of each vertex, behind its last one
    std::vector<std::uint32_t> triangles;

    std::span<const std::uint32_t> of(std::size_t vertex) const {
        const std::size_t first = vertex == 0 ? 0 : ends[vertex - 1];
        return std::span(triangles).subspan(first, ends[vertex] - first);
    }
};

TrianglesAtVertices triangles_at_vertices(const Mesh& mesh, const CancelFlag* cancel) {
    TrianglesAtVertices at;
    at.ends.resize(mesh.positions.size() + 1);
    for (const std::uint32_t vertex : mesh.position_indices)
        ++at.ends[vertex + 1];
    std::partial_sum(at.ends.begin(), at.ends.end(), at.ends.begin());
    at.triangles.resize(mesh.position_indices.size());
    // Each begins where the one before it ends, and has grown up to its own end when all are done.
    const LongLoop loop(mesh.position_indices.size(), {}, cancel);
    for (std::size_t i = 0; i < mesh.position_indices.size(); ++i) {
        loop.turn(i);
        at.triangles[at.ends[mesh.position_indices[i]]++] = static_cast<std::uint32_t>(i / 3);
    }
    return at;
}

/// More triangles than this have a side in common in no surface. Where they do, as in heaps of
/// copies, comparing each with each would take long, and none are joined across it.
constexpr std::ptrdiff_t most_at_a_side = 64;

using TrianglePair = std::array<std::uint32_t, 2>;

/// Adds the neighbours in one plane along the sides from the vertex to those of a larger number.
class NeighboursAt {
public:
    NeighboursAt(const Mesh& mesh, std::span<const std::uint32_t> ends)
        : mesh_(mesh)
        , ends_(ends) {}

    void
    add(std::uint32_t vertex,
        std::span<const std::uint32_t> triangles,
        std::vector<TrianglePair>& pairs) {
        round_.clear();
        for (const std::uint32_t triangle : triangles)
            round_.push_back(triangle_at(mesh_, triangle, vertex));
        std::sort(round_.begin(), round_.end(), by_last);
        for (const TriangleAt& one : round_) {
            if (one.next < vertex)
                continue;
            const auto [first, end] =
                std::equal_range(round_.begin(), round_.end(), TriangleAt{0, 0, one.next}, by_last);
            if (end - first > most_at_a_side)
                continue;
            for (auto other = first; other != end; ++other)
                if (are_in_one_plane(mesh_, vertex, one, *other)
                    && stretch_of(one.triangle) == stretch_of(other->triangle))
                    pairs.push_back({one.triangle, other->triangle});
        }
    }

private:
    static bool by_last(const TriangleAt& a, const TriangleAt& b) { return a.last < b.last; }

    std::ptrdiff_t stretch_of(std::uint32_t triangle) const {
        return std::upper_bound(ends_.begin(), ends_.end(), triangle) - ends_.begin();
    }

    const Mesh& mesh_;
    std::span<const std::uint32_t> ends_;
    std::vector<TriangleAt> round_;
};

} // namespace

std::vector<std::uint32_t>
coplanar_patches(const Mesh& mesh, std::span<const std::uint32_t> ends, const CancelFlag* cancel) {
    const TrianglesAtVertices at = triangles_at_vertices(mesh, cancel);
    DisjointSets patches(mesh.triangle_count());
    bool any = false;
    std::mutex mutex;
    parallel_ranges(mesh.positions.size(), 4096, [&](std::size_t first, std::size_t last) {
        stop_if_raised(cancel);
        NeighboursAt neighbours(mesh, ends);
        std::vector<TrianglePair> pairs;
        for (std::size_t vertex = first; vertex < last; ++vertex)
            neighbours.add(static_cast<std::uint32_t>(vertex), at.of(vertex), pairs);
        // Whichever block is first: of each set the smallest number stands for it.
        const std::lock_guard lock(mutex);
        for (const TrianglePair& pair : pairs)
            patches.join(pair[0], pair[1]);
        any = any || !pairs.empty();
    });
    std::vector<std::uint32_t> first_of(any ? mesh.triangle_count() : 0);
    for (std::uint32_t i = 0; i < first_of.size(); ++i)
        first_of[i] = patches.first_of(i);
    return first_of;
}

} // namespace vera
