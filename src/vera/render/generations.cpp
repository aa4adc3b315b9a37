// SPDX-License-Identifier: Apache-2.0
#include "vera/render/generations.h"

#include "vera/render/long_generations.h"
#include "vera/shade/firmament.h"
#include "vera/shade/surface_blocks.h"

#include <algorithm>
#include <array>
#include <bit>

namespace vera {

using namespace detail;

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
    for_each_range(rays.size(), rays_of_range, [&](std::size_t first, std::size_t last) {
        PlaceBlock block;
        std::array<MetFace, block_size> met;
        std::array<SurfacePoint*, block_size> places;
        for (std::size_t i = first; i < last;) {
            std::size_t count = 0;
            for (; i < last && count < block_size; ++i) {
                if (!hits[i].found())
                    continue;
                met[count] = {&rays[i].ray, &hits[i]};
                places[count++] = &at[i];
            }
            const std::array<MaterialId, block_size> materials =
                put_surfaces(traced_.scene, std::span(met).first(count), block);
            for (std::size_t lane = 0; lane < count; ++lane)
                *places[lane] = surface_in(block, lane, materials[lane], met[lane].hit->face);
        }
    });
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
            [&](std::span<const Place> places, PlaceBlock& block) {
                std::array<MaterialId, block_size> materials = {};
                for (std::size_t lane = 0; lane < places.size(); ++lane) {
                    const std::size_t ray = first + places[lane].ray;
                    put_surface(block, lane, at[ray], rays[ray].ray.direction);
                    materials[lane] = at[ray].material;
                }
                return materials;
            },
            part_colors);
        shade_places(1, part_colors);
    }
    work.terms = nullptr;
}

void GenerationTracer::trace(std::span<const QueryRay> rays, std::span<Color> colors) {
    const std::size_t size = std::min(traced_.generation_size, rays.size());
    for (std::size_t first = 0; first < rays.size(); first += size) {
        const std::size_t count = std::min(size, rays.size() - first);
        Level& work = level_buffers(1);
        work.hits.resize(count);
        trace_part(1, rays.subspan(first, count), work.hits, {}, colors.subspan(first, count));
    }
}

void GenerationTracer::trace(
    std::span<const QueryRay> rays,
    std::span<Hit> hits,
    std::span<SurfacePoint> at,
    std::span<Color> colors) {
    const std::size_t size = std::min(traced_.generation_size, rays.size());
    for (std::size_t first = 0; first < rays.size(); first += size) {
        const std::size_t count = std::min(size, rays.size() - first);
        trace_part(
            1,
            rays.subspan(first, count),
            hits.subspan(first, count),
            at.subspan(first, count),
            colors.subspan(first, count));
    }
}

/// Where nobody asks where the rays meet a face, at is empty.
void GenerationTracer::trace_part(
    std::uint32_t level,
    std::span<const QueryRay> rays,
    std::span<Hit> hits,
    std::span<SurfacePoint> at,
    std::span<Color> colors) {
    Level& work = level_buffers(level);
    nearest(rays, hits);
    find_places(
        work,
        rays,
        hits,
        [&](std::span<const Place> places, PlaceBlock& block) {
            std::array<MetFace, block_size> met;
            for (std::size_t lane = 0; lane < places.size(); ++lane) {
                const std::uint32_t ray = places[lane].ray;
                met[lane] = {&rays[ray].ray, &hits[ray]};
            }
            const std::array<MaterialId, block_size> materials =
                put_surfaces(traced_.scene, std::span(met).first(places.size()), block);
            if (!at.empty())
                for (std::size_t lane = 0; lane < places.size(); ++lane)
                    at[places[lane].ray] =
                        surface_in(block, lane, materials[lane], met[lane].hit->face);
            return materials;
        },
        colors);
    shade_places(level, colors);
}

template <typename PutSurfaces>
void GenerationTracer::find_places(
    Level& level,
    std::span<const QueryRay> rays,
    std::span<const Hit> hits,
    const PutSurfaces& put_surfaces_of,
    std::span<Color> colors) {
    level.places.resize(rays.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (hits[i].found())
            level.places[count++].ray = static_cast<std::uint32_t>(i);
    level.places.resize(count);
    level.blocks.resize(block_of(count + block_size - 1));
    if (level.terms != nullptr)
        std::fill_n(level.terms, rays.size() * level.term_stride, Color{});
    for_each_range(rays.size(), rays_of_range, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            if (hits[i].found())
                continue;
            colors[i] = firmament_color(traced_.firmament, rays[i].ray.direction);
            if (level.terms != nullptr)
                level.terms[i * level.term_stride + terms().firmament()] = colors[i];
        }
    });
    for_each_range(level.blocks.size(), blocks_of_range, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const std::size_t first_place = i * block_size;
            const std::span<Place> places =
                std::span(level.places)
                    .subspan(first_place, std::min(block_size, count - first_place));
            PlaceBlock& block = level.blocks[i];
            const std::array<MaterialId, block_size> materials = put_surfaces_of(places, block);
            block.lanes = (BlockLanes{1} << places.size()) - 1;
            block.refracting = 0;
            for (std::size_t lane = 0; lane < places.size(); ++lane) {
                Place& place = places[lane];
                const auto number = static_cast<std::size_t>(materials[lane]);
                place.look = number < looks_.size() ? &looks_[number] : &looks_.back();
                place.face = hits[place.ray].face;
                put_material(block, lane, *place.look->material);
                block.refracting |= BlockLanes{place.look->refracts} << lane;
            }
        }
        turn_to_viewer(std::span(level.blocks).subspan(first, last - first));
    });
    const auto any = [&](bool Look::*is) {
        return std::any_of(level.places.begin(), level.places.end(), [&](const Place& place) {
            return place.look->*is;
        });
    };
    level.mirrors = any(&Look::mirrors);
    level.refracts = any(&Look::refracts);
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
    const auto of_range = [](auto& buffer, std::size_t first, std::size_t last) {
        return std::span(buffer).subspan(first, last - first);
    };
    for_each_range(lights_.size(), blocks_of_range, [&](std::size_t first, std::size_t last) {
        const std::span<LightBlock> lights = of_range(lights_, first, last);
        light_up(of_range(level.blocks, first, last), traced_.illumination.lights[light], lights);
        if (traced_.shadows)
            return;
        for (LightBlock& block : lights)
            for (BlockRow& row : block.visibility)
                row.fill(1);
    });
    if (traced_.shadows)
        cast_shadows(level);
    for_each_range(lights_.size(), blocks_of_range, [&](std::size_t first, std::size_t last) {
        add_light(of_range(level.blocks, first, last), of_range(lights_, first, last));
    });
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
    first_shadow_rays_.resize(lights_.size());
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        first_shadow_rays_[i] = count;
        count += static_cast<std::uint32_t>(std::popcount(lights_[i].lit));
    }
    if (count == 0)
        return;
    shadow_rays_.resize(level.places.size());
    for_each_range(lights_.size(), blocks_of_range, [&](std::size_t first, std::size_t last) {
        QueryRay* shadow_ray = shadow_rays_.data() + first_shadow_rays_[first];
        for (std::size_t i = first; i < last; ++i) {
            const PlaceBlock& block = level.blocks[i];
            const LightBlock& light = lights_[i];
            const Place* places = &level.places[i * block_size];
            for_each_lane(light.lit, [&](std::size_t lane) {
                set_ray(
                    *shadow_ray, block, lane, places[lane].face, vector_at(light.to_light, lane));
                shadow_ray->ray.t_max = light.shadow_end[lane];
                ++shadow_ray;
            });
        }
    });
    if (traced_.cancel != nullptr)
        traced_.cancel->throw_if_raised();
    visibilities_.resize(level.places.size());
    const std::span<Color> visibilities = std::span(visibilities_).first(count);
    traced_.index.transmittances(
        std::span(shadow_rays_).first(count), visibilities, statistics.queries);
    statistics.shadow_rays += count;
    for_each_range(lights_.size(), blocks_of_range, [&](std::size_t first, std::size_t last) {
        const Color* visibility = visibilities.data() + first_shadow_rays_[first];
        for (std::size_t i = first; i < last; ++i)
            for_each_lane(lights_[i].lit, [&](std::size_t lane) {
                put(lights_[i].visibility, lane, *visibility++);
            });
    });
}

void GenerationTracer::color_places(const Level& level, std::span<Color> colors) {
    reflected_.resize(level.blocks.size());
    for_each_range(level.blocks.size(), blocks_of_range, [&](std::size_t first, std::size_t last) {
        reflected_light(
            std::span(level.blocks).subspan(first, last - first),
            traced_.illumination.ambient,
            std::span(reflected_).subspan(first, last - first));
        const std::size_t end = std::min(last * block_size, level.places.size());
        for (std::size_t i = first * block_size; i < end; ++i)
            color_place(level, i, colors);
    });
}

void GenerationTracer::color_place(
    const Level& level, std::size_t number, std::span<Color> colors) const {
    const Place& place = level.places[number];
    const PlaceBlock& block = level.blocks[block_of(number)];
    const std::size_t lane = lane_of(number);
    Color color = color_at(reflected_[block_of(number)], lane);
    if (place.look->is_luminous)
        color += luminosity(block.cos_viewer[lane], *place.look->material);
    colors[place.ray] = color;
    if (level.terms == nullptr)
        return;
    LocalTerms local =
        unlit(incidence_at(block, lane), *place.look->material, traced_.illumination.ambient);
    if (!traced_.luminosity)
        local.luminosity = {};
    Color* const ray_terms = level.terms + place.ray * level.term_stride;
    ray_terms[RayTerms::ambient()] = local.ambient;
    ray_terms[terms().luminosity()] = local.luminosity;
}

} // namespace vera
