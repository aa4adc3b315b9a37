// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/float_tree.h"
#include "vera/accel/mesh_crossing.h"
#include "vera/accel/mesh_index.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera::detail {

/// The tree of boxes of a mesh. In a leaf stand the coordinates of its triangles' corners.
struct MeshTree : FloatTree {
    using Hit = MeshHit;
    static constexpr std::size_t leaf_rows = 10;
    static constexpr std::size_t groups_at_once = 16;
    static constexpr std::uint32_t most_beam_steps = 48;
    static constexpr bool shafts = true;

    MeshSpans mesh;
    MeshIndexStatistics statistics;
};

inline MeshDecider decider_of(const MeshTree& tree, const MeshRay& ray) {
    return {tree.mesh, ray};
}

/// MeshIndex::MeshIndex
MeshTree build_mesh_tree(MeshSpans mesh, MeshIndexQuality quality, const CancelFlag* cancel);

/// MeshIndex::nearest_hits and meet_any.
void search_nearest(
    const MeshTree& tree,
    std::span<const MeshRay> rays,
    std::span<MeshHit> hits,
    SearchCounts& counts);
void search_any(
    const MeshTree& tree,
    std::span<const MeshRay> rays,
    std::span<std::uint8_t> met,
    SearchCounts& counts);

/// The same for one ray.
void search_nearest_alone(const MeshTree& tree, const MeshRay& ray, MeshHit& hit);
bool search_any_alone(const MeshTree& tree, const MeshRay& ray);

/// The same for one ray, in double precision throughout: for rays that single precision cannot
/// follow.
MeshHit nearest_plainly(const MeshTree& tree, const MeshRay& ray);
bool meets_any_plainly(const MeshTree& tree, const MeshRay& ray);

/// MeshIndex::all_hits
std::vector<MeshHit> all_hits_of(const MeshTree& tree, const MeshRay& ray);

} // namespace vera::detail
