// SPDX-License-Identifier: Apache-2.0
#include "vera/render/generations.h"

#include "vera/base/check.h"
#include "vera/scene/crossings.h"
#include "vera/shade/firmament.h"

#include <algorithm>

namespace vera {

namespace {

/// From the surface to the light: t is 0 there and 1 here. What is as near to the light as rounding
/// can tell is not between them.
QueryRay shadow_ray(const SurfacePoint& surface, Vec3 light_position) {
    QueryRay query;
    query.ray.origin = surface.point;
    query.ray.origin_error = surface.point_error;
    query.ray.direction = light_position - surface.point;
    query.ray.t_max = 1 - coincidence_tolerance(query.ray, 1);
    query.start = surface.face;
    return query;
}

} // namespace

TracedScene traced_scene(
    const Scene& scene,
    const RayIndex& index,
    const PictureSettings& settings,
    const CancelFlag* cancel) {
    return {
        .scene = scene,
        .index = index,
        .illumination = {scene.lights, settings.ambient},
        .firmament = settings.firmament,
        .shadows = settings.shadows,
        .luminosity = true,
        .depth = settings.depth,
        .cancel = cancel};
}

GenerationTracer::GenerationTracer(const TracedScene& traced)
    : traced_(traced) {}

GenerationTracer::Level& GenerationTracer::level_buffers(std::uint32_t level) {
    while (levels_.size() <= level)
        levels_.push_back(std::make_unique<Level>());
    return *levels_[level];
}

void GenerationTracer::nearest(std::span<const QueryRay> rays, std::span<Hit> hits) {
    if (traced_.cancel != nullptr)
        traced_.cancel->throw_if_raised();
    traced_.index.nearest_hits(rays, hits, statistics.queries);
}

void GenerationTracer::surfaces(
    std::span<const QueryRay> rays, std::span<const Hit> hits, std::span<SurfacePoint> at) {
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (hits[i].found())
            at[i] = surface_at(traced_.scene, rays[i].ray, hits[i]);
}

void GenerationTracer::shade(
    std::span<const QueryRay> rays,
    std::span<const Hit> hits,
    std::span<const SurfacePoint> at,
    std::span<Color> colors) {
    for (std::size_t first = 0; first < rays.size(); first += generation_size) {
        const std::size_t count = std::min(generation_size, rays.size() - first);
        shade_part(
            1,
            rays.subspan(first, count),
            hits.subspan(first, count),
            at.subspan(first, count),
            colors.subspan(first, count));
    }
}

void GenerationTracer::trace(std::span<const QueryRay> rays, std::span<Color> colors) {
    for (std::size_t first = 0; first < rays.size(); first += generation_size) {
        const std::size_t count = std::min(generation_size, rays.size() - first);
        trace_part(1, rays.subspan(first, count), colors.subspan(first, count));
    }
}

void GenerationTracer::trace_part(
    std::uint32_t level, std::span<const QueryRay> rays, std::span<Color> colors) {
    Level& work = level_buffers(level);
    work.hits.resize(rays.size());
    work.surfaces.resize(rays.size());
    nearest(rays, work.hits);
    surfaces(rays, work.hits, work.surfaces);
    shade_part(level, rays, work.hits, work.surfaces, colors);
}

void GenerationTracer::shade_part(
    std::uint32_t level,
    std::span<const QueryRay> rays,
    std::span<const Hit> hits,
    std::span<const SurfacePoint> at,
    std::span<Color> colors) {
    Level& work = level_buffers(level);
    find_places(work, rays, hits, at, colors);
    for (const PointLight& light : traced_.illumination.lights)
        light_places(work.places, light);
    for (const LitPlace& place : work.places)
        colors[place.ray] = sum(place.terms);

    if (level >= traced_.depth)
        return;
    find_children(work);
    work.child_colors.resize(work.children.size());
    for (std::size_t first = 0; first < work.children.size(); first += generation_size) {
        const std::size_t count = std::min(generation_size, work.children.size() - first);
        trace_part(
            level + 1,
            std::span(work.child_rays).subspan(first, count),
            std::span(work.child_colors).subspan(first, count));
    }
    add_children(work, colors);
}

void GenerationTracer::find_places(
    Level& level,
    std::span<const QueryRay> rays,
    std::span<const Hit> hits,
    std::span<const SurfacePoint> at,
    std::span<Color> colors) const {
    level.places.clear();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Vec3 direction = rays[i].ray.direction;
        if (!hits[i].found()) {
            colors[i] = firmament_color(traced_.firmament, direction);
            continue;
        }
        LitPlace& place = level.places.emplace_back();
        place.at = incidence(at[i], direction);
        place.material = &material_of(traced_.scene, at[i].material);
        place.surface = &at[i];
        place.terms = unlit(place.at, *place.material, traced_.illumination.ambient);
        place.ray = static_cast<std::uint32_t>(i);
        if (!traced_.luminosity)
            place.terms.luminosity = {};
    }
}

void GenerationTracer::light_places(std::vector<LitPlace>& places, const PointLight& light) {
    lit_.clear();
    shadow_rays_.clear();
    for (std::size_t i = 0; i < places.size(); ++i) {
        LitPlace& place = places[i];
        const LightTerms terms = unshadowed(place.at, *place.material, light);
        if (is_black(terms))
            continue;
        if (!traced_.shadows) {
            place.terms += terms;
            continue;
        }
        lit_.push_back({static_cast<std::uint32_t>(i), terms});
        shadow_rays_.push_back(shadow_ray(*place.surface, light.position));
    }
    if (lit_.empty())
        return;

    if (traced_.cancel != nullptr)
        traced_.cancel->throw_if_raised();
    visibilities_.resize(lit_.size());
    traced_.index.transmittances(shadow_rays_, visibilities_, statistics.queries);
    statistics.shadow_rays += shadow_rays_.size();
    for (std::size_t i = 0; i < lit_.size(); ++i)
        places[lit_[i].place].terms += visibilities_[i] * lit_[i].terms;
}

void GenerationTracer::find_children(Level& level) {
    level.children.clear();
    level.child_rays.clear();
    for (std::uint32_t i = 0; i < level.places.size(); ++i) {
        const LitPlace& place = level.places[i];
        const bool mirrors = !is_black(place.material->rab);
        const bool refracts = !is_black(place.material->tab);
        const std::optional<Vec3> onward =
            refracts ? refracted(place.at, place.material->ref) : std::nullopt;
        if (refracts && !onward) {
            // One ray is both, so that rays caught in glass do not double at each level.
            send(level, i, Child::Kind::mirrored_and_totally_reflected, place.at.mirrored);
            ++statistics.mirrored_rays;
            continue;
        }
        if (mirrors) {
            send(level, i, Child::Kind::mirrored, place.at.mirrored);
            ++statistics.mirrored_rays;
        }
        if (onward) {
            send(level, i, Child::Kind::refracted, *onward);
            ++statistics.refracted_rays;
        }
    }
}

void GenerationTracer::send(
    Level& level, std::uint32_t place, Child::Kind kind, Vec3 direction) const {
    const SurfacePoint& surface = *level.places[place].surface;
    QueryRay query;
    query.ray.origin = surface.point;
    query.ray.origin_error = surface.point_error;
    query.ray.direction = direction;
    query.start = surface.face;
    level.child_rays.push_back(query);
    level.children.push_back({place, kind});
}

void GenerationTracer::add_children(const Level& level, std::span<Color> colors) const {
    for (std::size_t i = 0; i < level.children.size(); ++i) {
        const Child& child = level.children[i];
        const LitPlace& place = level.places[child.place];
        Color& color = colors[place.ray];
        if (child.kind != Child::Kind::refracted)
            color += place.material->rab * level.child_colors[i];
        if (child.kind != Child::Kind::mirrored)
            color += place.material->tab * level.child_colors[i];
    }
}

} // namespace vera
