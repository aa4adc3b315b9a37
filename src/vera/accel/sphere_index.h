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

/// No sphere.
constexpr std::uint32_t no_sphere = ~std::uint32_t{0};

/// Where a ray meets a sphere's surface, from outside or from inside. no_sphere and infinity where
/// it meets none.
struct SphereHit {
    float t = std::numeric_limits<float>::infinity();
    std::uint32_t sphere = no_sphere;

    bool found() const { return sphere != no_sphere; }

    friend bool operator==(const SphereHit&, const SphereHit&) = default;
};

/// Spheres as they lie in the caller's memory: the center's x, y and z, and the radius.
using SphereSpan = std::span<const std::array<float, 4>>;

struct SphereIndexStatistics {
    std::size_t spheres = 0; ///< that rays can meet
    /// That none can, as a number is none or infinite, or the radius negative.
    std::size_t left_out = 0;
    std::size_t levels = 0; ///< of nodes
    std::size_t nodes = 0;
    std::size_t leaves = 0;
    std::size_t bytes = 0; ///< of the index, without the spheres

    friend bool operator==(const SphereIndexStatistics&, const SphereIndexStatistics&) = default;
};

/// Steps that were counted while queries were answered.
struct SphereQueryCounts {
    std::uint64_t nodes = 0;   ///< visits of a ray, or of 16 together
    std::uint64_t spheres = 0; ///< tests of a ray, or of 16 together, with a sphere

    SphereQueryCounts& operator+=(const SphereQueryCounts& more) {
        nodes += more.nodes;
        spheres += more.spheres;
        return *this;
    }
};

namespace detail {
struct SphereTree;
}

/// Answers ray queries on spheres of single precision: the sibling of MeshIndex. The spheres are
/// not copied: they must outlive the index and not change. All queries may be made from many
/// threads at once.
///
/// A sphere is its surface: a ray meets it where it enters and where it leaves, and one that starts
/// inside only where it leaves. What is met is decided in double precision (see sphere_crossing.h).
/// The answer to a ray is the same, to the bit, whether it is asked about alone or among others,
/// and on every processor. What is said of MeshIndex about the order of many rays holds here as
/// well.
class SphereIndex {
public:
    /// Throws std::length_error where there are more than 2^31 - 1 spheres, std::bad_alloc, and
    /// Cancelled.
    explicit SphereIndex(
        SphereSpan spheres,
        IndexQuality quality = IndexQuality::usual,
        const CancelFlag* cancel = nullptr);
    ~SphereIndex();
    SphereIndex(SphereIndex&&) noexcept;
    SphereIndex& operator=(SphereIndex&&) noexcept;

    /// The hit of the smallest t, and among hits of the same t (in double precision) that of the
    /// sphere with the smallest number.
    SphereHit nearest_hit(const IndexRay& ray) const;

    /// The same for each of the rays; there must be as many hits.
    void nearest_hits(
        std::span<const IndexRay> rays,
        std::span<SphereHit> hits,
        SphereQueryCounts* counts = nullptr) const;

    /// Whether the ray meets any sphere.
    bool meets_any(const IndexRay& ray) const;

    /// The same for each of the rays: 1 where it does, else 0; there must be as many answers.
    void meet_any(
        std::span<const IndexRay> rays,
        std::span<std::uint8_t> met,
        SphereQueryCounts* counts = nullptr) const;

    /// Every hit, by t and then by sphere: where the ray enters a sphere and where it leaves it, or
    /// once where it touches it.
    std::vector<SphereHit> all_hits(const IndexRay& ray) const;

    const SphereIndexStatistics& statistics() const;

private:
    std::unique_ptr<const detail::SphereTree> tree_;
};

} // namespace vera
