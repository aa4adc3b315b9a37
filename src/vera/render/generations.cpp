// SPDX-License-Identifier: Apache-2.0
#include "vera/render/generations.h"

#include "vera/shade/firmament.h"

#include <algorithm>

namespace vera {

namespace {

/// Of the block that holds the place, and its lane there.
constexpr std::size_t block_of(std::size_t place) {
    return place / block_size;
}

constexpr std::size_t lane_of(std::size_t place) {
    return place % block_size;
}

constexpr BlockLanes lane_bit(std::size_t lane) {
    return BlockLanes{1} << lane;
}

/// Lets the ray, of which the rest is at its default, start from a place on that face.
void set_ray(
    QueryRay& query, const PlaceBlock& block, std::size_t lane, FaceId face, Vec3 direction) {
    query.ray.origin = vector_at(block.point, lane);
    query.ray.direction = direction;
    query.ray.origin_error = block.point_error[lane];
    query.start = face;
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
        .cancel = cancel,
        .generation_size = usual_generation_size};
}

std::size_t GenerationTracer::bytes_per_ray() {
    constexpr std::size_t blocks =
        sizeof(PlaceBlock) + sizeof(LightBlock) + sizeof(RefractionBlock) + sizeof(BlockRows);
    constexpr std::size_t of_child = sizeof(Child) + sizeof(QueryRay) + sizeof(Color);
    return sizeof(Hit) + sizeof(Place) + blocks / block_size + of_child + sizeof(QueryRay)
        + sizeof(Color);
}

GenerationTracer::GenerationTracer(const TracedScene& traced)
    : traced_(traced) {
    const auto add_look = [&](const Material& material) {
        looks_.push_back(
            {&material,
             !is_black(material.rab),
             !is_black(material.tab),
             traced.luminosity && !(is_black(material.san) && is_black(material.sdi))});
    };
    for (const Material& material : traced.scene.materials)
        add_look(material);
    add_look(material_of(traced.scene, inherited_material));
}

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
    std::span<Color> colors,
    std::span<Color> terms) {
    Level& work = level_buffers(1);
    const std::size_t size = std::min(traced_.generation_size, rays.size());
    for (std::size_t first = 0; first < rays.size(); first += size) {
        const std::size_t count = std::min(size, rays.size() - first);
        const std::span<const Hit> part_hits = hits.subspan(first, count);
        const std::span<Color> part_colors = colors.subspan(first, count);
        work.term_stride = light_way_count * this->terms().count();
        work.terms = terms.empty() ? nullptr : terms.data() + first * work.term_stride;
        find_places(
            work,
            rays.subspan(first, count),
            part_hits,
            [&](std::size_t i) -> const SurfacePoint& { return at[first + i]; },
            part_colors);
        shade_places(1, part_colors);
    }
    work.terms = nullptr;
}

void GenerationTracer::trace(std::span<const QueryRay> rays, std::span<Color> colors) {
    const std::size_t size = std::min(traced_.generation_size, rays.size());
    for (std::size_t first = 0; first < rays.size(); first += size) {
        const std::size_t count = std::min(size, rays.size() - first);
        trace_part(1, rays.subspan(first, count), colors.subspan(first, count));
    }
}

void GenerationTracer::trace_part(
    std::uint32_t level, std::span<const QueryRay> rays, std::span<Color> colors) {
    Level& work = level_buffers(level);
    work.hits.resize(rays.size());
    nearest(rays, work.hits);
    find_places(
        work,
        rays,
        work.hits,
        [&](std::size_t i) { return surface_at(traced_.scene, rays[i].ray, work.hits[i]); },
        colors);
    shade_places(level, colors);
}

template <typename SurfaceOf>
void GenerationTracer::find_places(
    Level& level,
    std::span<const QueryRay> rays,
    std::span<const Hit> hits,
    const SurfaceOf& surface_of,
    std::span<Color> colors) {
    level.places.resize(rays.size());
    level.blocks.resize(block_of(rays.size() + block_size - 1));
    level.mirrors = false;
    level.refracts = false;
    if (level.terms != nullptr)
        std::fill_n(level.terms, rays.size() * level.term_stride, Color{});
    std::size_t count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Vec3 direction = rays[i].ray.direction;
        if (!hits[i].found()) {
            colors[i] = firmament_color(traced_.firmament, direction);
            if (level.terms != nullptr)
                level.terms[i * level.term_stride + terms().firmament()] = colors[i];
            continue;
        }
        const SurfacePoint& surface = surface_of(i);
        const auto number = static_cast<std::size_t>(surface.material);
        const Look& look = number < looks_.size() ? looks_[number] : looks_.back();
        level.places[count] = {hits[i].face, &look, static_cast<std::uint32_t>(i)};
        PlaceBlock& block = level.blocks[block_of(count)];
        const std::size_t lane = lane_of(count);
        if (lane == 0)
            block.lanes = block.refracting = 0;
        put_place(block, lane, surface, direction, *look.material);
        block.lanes |= lane_bit(lane);
        block.refracting |= BlockLanes{look.refracts} << lane;
        level.mirrors |= look.mirrors;
        level.refracts |= look.refracts;
        ++count;
    }
    level.places.resize(count);
    level.blocks.resize(block_of(count + block_size - 1));
    turn_to_viewer(level.blocks);
}

void GenerationTracer::shade_places(std::uint32_t level, std::span<Color> colors) {
    Level& work = level_buffers(level);
    for (std::size_t light = 0; light < traced_.illumination.lights.size(); ++light)
        light_places(work, light);
    color_places(work, colors);
    if (level < traced_.depth && (work.mirrors || work.refracts))
        trace_children(level, colors);
}

void GenerationTracer::light_places(Level& level, std::size_t light) {
    lights_.resize(level.blocks.size());
    light_up(level.blocks, traced_.illumination.lights[light], lights_);
    if (traced_.shadows)
        cast_shadows(level);
    else
        for (LightBlock& block : lights_)
            for (BlockRow& row : block.visibility)
                row.fill(1);
    add_light(level.blocks, lights_);
    if (level.terms != nullptr)
        note_light(level, light);
}

void GenerationTracer::note_light(const Level& level, std::size_t light) const {
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        const LightBlock& block = lights_[i];
        for_each_lane(block.lit, [&](std::size_t lane) {
            const Place& place = level.places[i * block_size + lane];
            Color* const ray_terms = level.terms + place.ray * level.term_stride;
            const Color visibility = color_at(block.visibility, lane);
            ray_terms[terms().diffuse(light)] = visibility * color_at(block.diffuse, lane);
            ray_terms[terms().highlight(light)] = visibility * color_at(block.highlight, lane);
        });
    }
}

void GenerationTracer::cast_shadows(const Level& level) {
    shadow_rays_.resize(level.places.size());
    QueryRay* shadow_ray = shadow_rays_.data();
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        const PlaceBlock& block = level.blocks[i];
        const LightBlock& light = lights_[i];
        const Place* places = &level.places[i * block_size];
        for_each_lane(light.lit, [&](std::size_t lane) {
            set_ray(*shadow_ray, block, lane, places[lane].face, vector_at(light.to_light, lane));
            shadow_ray->ray.t_max = light.shadow_end[lane];
            ++shadow_ray;
        });
    }
    const auto count = static_cast<std::size_t>(shadow_ray - shadow_rays_.data());
    if (count == 0)
        return;
    if (traced_.cancel != nullptr)
        traced_.cancel->throw_if_raised();
    visibilities_.resize(level.places.size());
    const std::span<Color> visibilities = std::span(visibilities_).first(count);
    traced_.index.transmittances(
        std::span(shadow_rays_).first(count), visibilities, statistics.queries);
    statistics.shadow_rays += count;

    const Color* visibility = visibilities.data();
    for (LightBlock& light : lights_)
        for_each_lane(
            light.lit, [&](std::size_t lane) { put(light.visibility, lane, *visibility++); });
}

void GenerationTracer::color_places(const Level& level, std::span<Color> colors) {
    reflected_.resize(level.blocks.size());
    reflected_light(level.blocks, traced_.illumination.ambient, reflected_);
    for (std::size_t i = 0; i < level.places.size(); ++i) {
        const Place& place = level.places[i];
        const std::size_t lane = lane_of(i);
        Color color = color_at(reflected_[block_of(i)], lane);
        if (place.look->is_luminous)
            color += luminosity(level.blocks[block_of(i)].cos_viewer[lane], *place.look->material);
        colors[place.ray] = color;
        if (level.terms != nullptr) {
            const Incidence at = incidence_at(level.blocks[block_of(i)], lane);
            LocalTerms local = unlit(at, *place.look->material, traced_.illumination.ambient);
            if (!traced_.luminosity)
                local.luminosity = {};
            Color* const ray_terms = level.terms + place.ray * level.term_stride;
            ray_terms[RayTerms::ambient()] = local.ambient;
            ray_terms[terms().luminosity()] = local.luminosity;
        }
    }
}

void GenerationTracer::trace_children(std::uint32_t level, std::span<Color> colors) {
    // All mirrored rays come before all refracted ones, so that neighbours stay close together.
    Level& work = level_buffers(level);
    const std::size_t most = work.places.size() * (work.refracts ? 2 : 1);
    work.children.resize(most);
    work.child_rays.resize(most);
    if (work.refracts) {
        refractions_.resize(work.blocks.size());
        refract(work.blocks, refractions_);
    }
    find_mirrored(work);
    if (work.refracts)
        find_refracted(work);

    work.child_colors.resize(work.children.size());
    Level& next = level_buffers(level + 1);
    next.term_stride = terms().count();
    if (work.terms != nullptr)
        work.child_terms.resize(work.children.size() * next.term_stride);
    const std::size_t size = std::min(traced_.generation_size, work.children.size());
    for (std::size_t first = 0; first < work.children.size(); first += size) {
        const std::size_t count = std::min(size, work.children.size() - first);
        next.terms =
            work.terms == nullptr ? nullptr : work.child_terms.data() + first * next.term_stride;
        trace_part(
            level + 1,
            std::span(work.child_rays).subspan(first, count),
            std::span(work.child_colors).subspan(first, count));
    }
    next.terms = nullptr;
    add_children(work, colors);
}

void GenerationTracer::find_mirrored(Level& level) {
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < level.places.size(); ++i) {
        const Place& place = level.places[i];
        const std::size_t lane = lane_of(i);
        // One ray is both, so that rays caught in glass do not double at each level.
        const bool is_total = place.look->refracts
            && (refractions_[block_of(i)].totally_reflected & lane_bit(lane)) != 0;
        if (!place.look->mirrors && !is_total)
            continue;
        const PlaceBlock& block = level.blocks[block_of(i)];
        set_ray(level.child_rays[count], block, lane, place.face, vector_at(block.mirrored, lane));
        level.children[count++] = {
            i, is_total ? Child::Kind::mirrored_and_totally_reflected : Child::Kind::mirrored};
    }
    level.children.resize(count);
    statistics.mirrored_rays += count;
}

void GenerationTracer::find_refracted(Level& level) {
    std::size_t count = level.children.size();
    statistics.refracted_rays -= count;
    level.children.resize(level.child_rays.size());
    for (std::size_t i = 0; i < level.blocks.size(); ++i) {
        const PlaceBlock& block = level.blocks[i];
        const RefractionBlock& refraction = refractions_[i];
        for_each_lane(block.refracting & ~refraction.totally_reflected, [&](std::size_t lane) {
            const std::size_t place = i * block_size + lane;
            set_ray(
                level.child_rays[count],
                block,
                lane,
                level.places[place].face,
                vector_at(refraction.direction, lane));
            level.children[count++] = {static_cast<std::uint32_t>(place), Child::Kind::refracted};
        });
    }
    level.children.resize(count);
    statistics.refracted_rays += count;
}

void GenerationTracer::add_children(const Level& level, std::span<Color> colors) const {
    for (std::size_t i = 0; i < level.children.size(); ++i) {
        const Child& child = level.children[i];
        const Place& place = level.places[child.place];
        Color& color = colors[place.ray];
        if (child.kind != Child::Kind::refracted)
            color += place.look->material->rab * level.child_colors[i];
        if (child.kind != Child::Kind::mirrored)
            color += place.look->material->tab * level.child_colors[i];
        if (level.terms != nullptr)
            add_child_terms(level, i);
    }
}

void GenerationTracer::add_child_terms(const Level& level, std::size_t child) const {
    const std::size_t count = terms().count();
    const bool keeps_ways = level.term_stride > count;
    const Place& place = level.places[level.children[child].place];
    const Color* const child_terms = level.child_terms.data() + child * count;
    const auto add = [&](LightWay way, Color part) {
        Color* const ray_terms = level.terms + place.ray * level.term_stride
            + (keeps_ways ? term_number(terms(), way, 0) : 0);
        for (std::size_t i = 0; i < count; ++i)
            ray_terms[i] += part * child_terms[i];
    };
    const Child::Kind kind = level.children[child].kind;
    if (kind != Child::Kind::refracted)
        add(LightWay::mirrored, place.look->material->rab);
    if (kind != Child::Kind::mirrored)
        add(LightWay::refracted, place.look->material->tab);
}

} // namespace vera
