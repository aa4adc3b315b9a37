// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/base/parallel.h"
#include "vera/scene/facets.h"
#include "vera/scene/scene.h"
#include "vera/theory/central_queries.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace vera {

/// Which rays a CentralIndex answers, and how.
struct CentralIndexSettings {
    Vec3 viewpoint;
    bool shadows = true; ///< whether rays to the lights are asked
    LocatorKind locator = LocatorKind::slabs;
};

/// Answers the rays of simple ray tracing (VERA 3.2): those that start at the view point, and those
/// that end at a light of the scene, each by one central query, in O(log n) steps. There may be no
/// others: what mirrors or refracts sends rays that start anywhere.
///
/// A query tells which facet is seen. Where the ray meets the facet's primitive is decided by the
/// arithmetic that decides all hits, and so is whether that lies before the light. Where the ray
/// passes it by, within a step of the map's grid from a border, the facet's plane stands for it:
/// there alone is the answer another one than that of other indexes. The facets of curved surfaces
/// lie off them, and that much farther from a silhouette it may differ as well.
class CentralIndex : public RayIndex {
public:
    /// Of a scene in which nothing lets light through. The facets are the scene's. Throws
    /// Cancelled, and std::runtime_error where the memory that is available does not suffice.
    CentralIndex(
        const Scene& scene,
        std::unique_ptr<const Facets> facets,
        const CentralIndexSettings& settings,
        const Progress& progress = {},
        const CancelFlag* cancel = nullptr);

    /// The rays must start at the view point. A cell that is counted is a step of a locator.
    void nearest_hits(
        std::span<const QueryRay> rays, std::span<Hit> hits, QueryCounts& counts) const override;

    /// The rays must end, at t = 1, at a light: rounding aside, of which the nearest one is taken.
    void transmittances(
        std::span<const QueryRay> rays,
        std::span<Color> transmitted,
        QueryCounts& counts) const override;

    std::size_t memory() const override;

    /// The largest CentralQueries::cut_distance(), for the view point and for the lights.
    double view_cut_distance() const { return view_.cut_distance(); }

    double light_cut_distance() const;

    /// Pairs of facets that still penetrate each other, as seen from all points together.
    std::size_t penetrating() const;

private:
    const CentralQueries& queries_of(const Ray& ray) const;
    bool is_blocked(const QueryRay& query, QueryCounts& counts) const;

    const Scene* scene_;
    std::unique_ptr<const Facets> facets_;
    Vec3 viewpoint_;
    CentralQueries view_;
    std::vector<std::unique_ptr<const CentralQueries>> lights_; ///< of each of the scene's
};

} // namespace vera
