// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/float_tree.h"
#include "vera/accel/sphere_crossing.h"
#include "vera/accel/sphere_index.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera::detail {

/// The tree of boxes of spheres. In a leaf stand their centers and radii.
struct SphereTree : FloatTree {
    using Hit = SphereHit;
    static constexpr std::size_t leaf_rows = 5;
    static constexpr std::size_t groups_at_once = 32;
    static constexpr std::uint32_t most_beam_steps = 400;
    static constexpr bool shafts = false;

    SphereSpan spheres;
    SphereIndexStatistics statistics;
};

inline SphereDecider decider_of(const SphereTree& tree, const IndexRay& ray) {
    return {tree.spheres, ray};
}

/// SphereIndex::SphereIndex
SphereTree build_sphere_tree(SphereSpan spheres, IndexQuality quality, const CancelFlag* cancel);

/// SphereIndex::nearest_hits and meet_any.
void search_nearest(
    const SphereTree& tree,
    std::span<const IndexRay> rays,
    std::span<SphereHit> hits,
    SearchCounts& counts);
void search_any(
    const SphereTree& tree,
    std::span<const IndexRay> rays,
    std::span<std::uint8_t> met,
    SearchCounts& counts);

/// The same for one ray.
void search_nearest_alone(const SphereTree& tree, const IndexRay& ray, SphereHit& hit);
bool search_any_alone(const SphereTree& tree, const IndexRay& ray);

/// The same for one ray, in double precision throughout: for rays that single precision cannot
/// follow.
SphereHit nearest_plainly(const SphereTree& tree, const IndexRay& ray);
bool meets_any_plainly(const SphereTree& tree, const IndexRay& ray);

/// SphereIndex::all_hits
std::vector<SphereHit> all_hits_of(const SphereTree& tree, const IndexRay& ray);

} // namespace vera::detail
