// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/mesh_index.h"

#include "vera/accel/mesh_tree.h"
#include "vera/accel/simd_level.h"
#include "vera/base/check.h"

namespace vera {

MeshIndex::MeshIndex(MeshSpans mesh, MeshIndexQuality quality, const CancelFlag* cancel) {
    honour_simd_environment();
    tree_ =
        std::make_unique<const detail::MeshTree>(detail::build_mesh_tree(mesh, quality, cancel));
}

MeshIndex::~MeshIndex() = default;
MeshIndex::MeshIndex(MeshIndex&&) noexcept = default;
MeshIndex& MeshIndex::operator=(MeshIndex&&) noexcept = default;

MeshHit MeshIndex::nearest_hit(const MeshRay& ray) const {
    MeshHit hit;
    detail::search_nearest_alone(*tree_, ray, hit);
    return hit;
}

void MeshIndex::nearest_hits(
    std::span<const MeshRay> rays, std::span<MeshHit> hits, MeshQueryCounts* counts) const {
    VERA_CHECK(rays.size() == hits.size());
    if (rays.size() == 1 && counts == nullptr) {
        hits[0] = nearest_hit(rays[0]);
        return;
    }
    detail::SearchCounts own;
    detail::search_nearest(*tree_, rays, hits, own);
    if (counts != nullptr)
        *counts += {own.nodes, own.tests};
}

bool MeshIndex::meets_any(const MeshRay& ray) const {
    return detail::search_any_alone(*tree_, ray);
}

void MeshIndex::meet_any(
    std::span<const MeshRay> rays, std::span<std::uint8_t> met, MeshQueryCounts* counts) const {
    VERA_CHECK(rays.size() == met.size());
    if (rays.size() == 1 && counts == nullptr) {
        met[0] = meets_any(rays[0]) ? 1 : 0;
        return;
    }
    detail::SearchCounts own;
    detail::search_any(*tree_, rays, met, own);
    if (counts != nullptr)
        *counts += {own.nodes, own.tests};
}

std::vector<MeshHit> MeshIndex::all_hits(const MeshRay& ray) const {
    return detail::all_hits_of(*tree_, ray);
}

const MeshIndexStatistics& MeshIndex::statistics() const {
    return tree_->statistics;
}

} // namespace vera
