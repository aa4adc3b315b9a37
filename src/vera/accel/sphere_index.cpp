// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/sphere_index.h"

#include "vera/accel/simd_level.h"
#include "vera/accel/sphere_tree.h"
#include "vera/base/check.h"

namespace vera {

SphereIndex::SphereIndex(SphereSpan spheres, IndexQuality quality, const CancelFlag* cancel) {
    honour_simd_environment();
    tree_ = std::make_unique<const detail::SphereTree>(
        detail::build_sphere_tree(spheres, quality, cancel));
}

SphereIndex::~SphereIndex() = default;
SphereIndex::SphereIndex(SphereIndex&&) noexcept = default;
SphereIndex& SphereIndex::operator=(SphereIndex&&) noexcept = default;

SphereHit SphereIndex::nearest_hit(const IndexRay& ray) const {
    SphereHit hit;
    detail::search_nearest_alone(*tree_, ray, hit);
    return hit;
}

void SphereIndex::nearest_hits(
    std::span<const IndexRay> rays, std::span<SphereHit> hits, SphereQueryCounts* counts) const {
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

bool SphereIndex::meets_any(const IndexRay& ray) const {
    return detail::search_any_alone(*tree_, ray);
}

void SphereIndex::meet_any(
    std::span<const IndexRay> rays, std::span<std::uint8_t> met, SphereQueryCounts* counts) const {
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

std::vector<SphereHit> SphereIndex::all_hits(const IndexRay& ray) const {
    return detail::all_hits_of(*tree_, ray);
}

const SphereIndexStatistics& SphereIndex::statistics() const {
    return tree_->statistics;
}

} // namespace vera
