// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/index_ray.h"
#include "vera/base/parallel.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace vera {

using MeshRay = IndexRay;
using MeshIndexQuality = IndexQuality;

/// No triangle.
constexpr std::uint32_t no_triangle = ~std::uint32_t{0};

/// Where a ray meets a triangle with the corners a, b and c: at (1 - u - v) a + u b + v c.
/// no_triangle and infinity where it meets none.
struct MeshHit {
    float t = std::numeric_limits<float>::infinity();
    std::uint32_t triangle = no_triangle;
    float u = 0;
    float v = 0;

    bool found() const { return triangle != no_triangle; }

    friend bool operator==(const MeshHit&, const MeshHit&) = default;
};

/// A mesh as it lies in the caller's memory: triangle i has the corners
/// vertices[triangles[i][0 .. 2]].
struct MeshSpans {
    std::span<const std::array<float, 3>> vertices;
    std::span<const std::array<std::uint32_t, 3>> triangles;
};

struct MeshIndexStatistics {
    std::size_t triangles = 0; ///< that rays can meet
    std::size_t left_out = 0; ///< that none can, as a corner has a number that is none, or infinite
    std::size_t levels = 0;   ///< of nodes
    std::size_t nodes = 0;
    std::size_t leaves = 0;
    std::size_t bytes = 0; ///< of the index, without the mesh

    friend bool operator==(const MeshIndexStatistics&, const MeshIndexStatistics&) = default;
};

/// Steps that were counted while queries were answered.
struct MeshQueryCounts {
    std::uint64_t nodes = 0;     ///< visits of a ray, or of 16 together
    std::uint64_t triangles = 0; ///< tests of a ray, or of 16 together, with a triangle

    MeshQueryCounts& operator+=(const MeshQueryCounts& more) {
        nodes += more.nodes;
        triangles += more.triangles;
        return *this;
    }
};

namespace detail {
struct MeshTree;
}

/// Answers ray queries on one mesh of single precision. The mesh is not copied: it must outlive the
/// index and not change. All queries may be made from many threads at once.
///
/// What is met is decided watertight in double precision (see mesh_crossing.h): no ray passes
/// between triangles that share an edge or a corner. The answer to a ray is the same, to the bit,
/// whether it is asked about alone or among others, and on every processor.
///
/// Of many rays, those that follow each other should go nearly the same way where that is possible:
/// sixteen that start at one place, as of a square of 4 x 4 pixels, go through the index together,
/// and so do sixteen that run nearly alike where only is asked whether they meet anything, as those
/// to a light; of others those of 256 whose directions have the same signs. Thousands in one span
/// that start far from each other are put in order first.
class MeshIndex {
public:
    /// Throws std::invalid_argument where a triangle names a vertex that there is not,
    /// std::length_error where there are more than 2^31 - 1 triangles, std::bad_alloc, and
    /// Cancelled.
    explicit MeshIndex(
        MeshSpans mesh,
        MeshIndexQuality quality = MeshIndexQuality::usual,
        const CancelFlag* cancel = nullptr);
    ~MeshIndex();
    MeshIndex(MeshIndex&&) noexcept;
    MeshIndex& operator=(MeshIndex&&) noexcept;

    /// The hit of the smallest t, and among hits of the same t (in double precision) that of the
    /// triangle with the smallest number.
    MeshHit nearest_hit(const MeshRay& ray) const;

    /// The same for each of the rays; there must be as many hits.
    void nearest_hits(
        std::span<const MeshRay> rays,
        std::span<MeshHit> hits,
        MeshQueryCounts* counts = nullptr) const;

    /// Whether the ray meets any triangle.
    bool meets_any(const MeshRay& ray) const;

    /// The same for each of the rays: 1 where it does, else 0; there must be as many answers.
    void meet_any(
        std::span<const MeshRay> rays,
        std::span<std::uint8_t> met,
        MeshQueryCounts* counts = nullptr) const;

    /// Every hit, by t and then by triangle.
    std::vector<MeshHit> all_hits(const MeshRay& ray) const;

    const MeshIndexStatistics& statistics() const;

private:
    std::unique_ptr<const detail::MeshTree> tree_;
};

} // namespace vera
