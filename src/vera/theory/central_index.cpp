// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/central_index.h"

#include "vera/accel/primitive_hit.h"
#include "vera/base/check.h"
#include "vera/base/progress_part.h"
#include "vera/render/facet_hit.h"

#include <algorithm>
#include <utility>

namespace vera {

CentralIndex::CentralIndex(
    const Scene& scene,
    std::unique_ptr<const Facets> facets,
    const CentralIndexSettings& settings,
    const Progress& progress,
    const CancelFlag* cancel)
    : scene_(&scene)
    , facets_(std::move(facets))
    , viewpoint_(settings.viewpoint)
    , view_(
          *facets_,
          settings.viewpoint,
          settings.locator,
          progress_part(progress, 0, settings.shadows ? 1 + scene.lights.size() : 1),
          cancel) {
    if (!settings.shadows)
        return;
    for (std::size_t light = 0; light < scene.lights.size(); ++light)
        lights_.push_back(std::make_unique<const CentralQueries>(
            *facets_,
            scene.lights[light].position,
            settings.locator,
            progress_part(progress, 1 + light, 1 + scene.lights.size()),
            cancel));
}

void CentralIndex::nearest_hits(
    std::span<const QueryRay> rays, std::span<Hit> hits, QueryCounts& counts) const {
    VERA_CHECK(rays.size() == hits.size());
    LocatorSteps steps;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Ray& ray = rays[i].ray;
        VERA_CHECK(ray.origin == viewpoint_);
        const auto facet = view_.first_facet(ray.direction, steps);
        hits[i] = facet ? facet_hit(*scene_, *facets_, *facet, ray) : Hit{};
        counts.tests += facet ? 1 : 0;
    }
    counts.rays += rays.size();
    counts.cells += steps.comparisons;
}

const CentralQueries& CentralIndex::queries_of(const Ray& ray) const {
    VERA_CHECK(!lights_.empty());
    const Vec3 end = point_at(ray, 1);
    const auto& lights = scene_->lights;
    const auto nearest = std::min_element(
        lights.begin(), lights.end(), [&](const PointLight& a, const PointLight& b) {
            return dot(a.position - end, a.position - end)
                < dot(b.position - end, b.position - end);
        });
    return *lights_[static_cast<std::size_t>(nearest - lights.begin())];
}

bool CentralIndex::is_blocked(const QueryRay& query, QueryCounts& counts) const {
    // What a border of a map is off lies within a few steps of its grid.
    constexpr double sure_part = 0x1p-16;
    LocatorSteps steps;
    const auto facet = queries_of(query.ray).first_facet(-query.ray.direction, steps);
    counts.cells += steps.comparisons;
    if (!facet)
        return false;
    ++counts.tests;
    const std::uint64_t primitive = facets_->triangles[*facet].primitive;
    if (primitive_hit(*scene_, query, primitive).found())
        return true;
    if (primitive == query.start.primitive)
        return false;
    // The light sees it beside one of its borders, where the ray passes it by: it blocks the light
    // where its plane lies before the place, and not where it is a neighbour of the place's face.
    Ray unit_ray = query.ray;
    const double size = length(query.ray.direction);
    unit_ray.direction = query.ray.direction / size;
    const double part = facet_t(*facets_, *facet, unit_ray) / size;
    return part > sure_part && part < query.ray.t_max;
}

void CentralIndex::transmittances(
    std::span<const QueryRay> rays, std::span<Color> transmitted, QueryCounts& counts) const {
    VERA_CHECK(rays.size() == transmitted.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        transmitted[i] = is_blocked(rays[i], counts) ? Color{} : Color{1, 1, 1};
    counts.rays += rays.size();
}

std::size_t CentralIndex::memory() const {
    std::size_t bytes = sizeof(*this) + view_.memory() + facets_->corners.capacity() * sizeof(Vec3)
        + facets_->triangles.capacity() * sizeof(Facets::Triangle);
    for (const auto& light : lights_)
        bytes += light->memory();
    return bytes;
}

double CentralIndex::light_cut_distance() const {
    double largest = 0;
    for (const auto& light : lights_)
        largest = std::max(largest, light->cut_distance());
    return largest;
}

std::size_t CentralIndex::penetrating() const {
    std::size_t count = view_.penetrating();
    for (const auto& light : lights_)
        count += light->penetrating();
    return count;
}

} // namespace vera
