// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/color.h"
#include "vera/math/ray.h"
#include "vera/scene/hit.h"
#include "vera/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace vera {

/// A ray as it is asked about, and the face it starts from (which a plane face's ray never meets
/// again), if any.
struct QueryRay {
    Ray ray;
    FaceId start;
};

/// Steps counted while queries were answered. Each thread counts its own; add them up after.
struct QueryCounts {
    std::uint64_t rays = 0;
    std::uint64_t tests = 0; ///< of a ray with a primitive
    std::uint64_t cells = 0; ///< cells or nodes visited

    QueryCounts& operator+=(const QueryCounts& more) {
        rays += more.rays;
        tests += more.tests;
        cells += more.cells;
        return *this;
    }
};

/// What an index will take.
struct IndexForecast {
    std::size_t bytes = 0;           ///< of the index, and of what its build needs beside it
    std::size_t available_bytes = 0; ///< what the machine has to give now
};

/// Answers ray queries on a scene, which must outlive it and not change. Every index gives the same
/// bits: an index only leaves out what cannot be hit. All queries may be made from many threads.
class RayIndex {
public:
    RayIndex() = default;
    RayIndex(const RayIndex&) = delete;
    RayIndex& operator=(const RayIndex&) = delete;
    virtual ~RayIndex() = default;

    /// The first face that each ray meets: of those whose t lies within rounding of the smallest
    /// (see coincidence_tolerance), the one that stands first in the text.
    virtual void nearest_hits(
        std::span<const QueryRay> rays, std::span<Hit> hits, QueryCounts& counts) const = 0;

    /// The part of light of each colour that passes along each ray from t_min to t_max: the product
    /// of the TAB of the surfaces that it crosses, taken in the order of t and then of FaceId.
    virtual void transmittances(
        std::span<const QueryRay> rays,
        std::span<Color> transmitted,
        QueryCounts& counts) const = 0;

    /// Bytes of memory that the index holds beside the scene.
    virtual std::size_t memory() const = 0;
};

} // namespace vera
