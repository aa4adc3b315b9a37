// SPDX-License-Identifier: Apache-2.0
// The rays that a generation sends on from mirrors and glass, and what comes back along them.
#include "vera/render/generations.h"
#include "vera/render/long_generations.h"

#include <algorithm>

namespace vera {

using namespace detail;

void GenerationTracer::trace_children(std::uint32_t level, std::span<Color> colors) {
    // All mirrored rays come before all refracted ones, so that neighbours stay close together.
    Level& work = level_buffers(level);
    const std::size_t most = work.places.size() * (work.refracts ? 2 : 1);
    work.children.resize(most);
    if (work.refracts) {
        refractions_.resize(work.blocks.size());
        for_each_range(
            work.blocks.size(), blocks_of_range, [&](std::size_t first, std::size_t last) {
                refract(
                    std::span(work.blocks).subspan(first, last - first),
                    std::span(refractions_).subspan(first, last - first));
            });
    }
    find_mirrored(work);
    if (work.refracts)
        find_refracted(work);
    set_child_rays(work);

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
        next.hits.resize(count);
        trace_part(
            level + 1,
            std::span(work.child_rays).subspan(first, count),
            next.hits,
            {},
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
        level.children[count++] = {
            i, is_total ? Child::Kind::mirrored_and_totally_reflected : Child::Kind::mirrored};
    }
    level.children.resize(count);
    level.mirrored_children = count;
    statistics.mirrored_rays += count;
}

void GenerationTracer::find_refracted(Level& level) {
    std::size_t count = level.mirrored_children;
    level.children.resize(count + level.places.size());
    for (std::size_t i = 0; i < level.blocks.size(); ++i)
        for_each_lane(
            level.blocks[i].refracting & ~refractions_[i].totally_reflected, [&](std::size_t lane) {
                level.children[count++] = {
                    static_cast<std::uint32_t>(i * block_size + lane), Child::Kind::refracted};
            });
    level.children.resize(count);
    statistics.refracted_rays += count - level.mirrored_children;
}

void GenerationTracer::set_child_rays(Level& level) const {
    level.child_rays.resize(level.children.size());
    for_each_range(level.children.size(), rays_of_range, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const Child& child = level.children[i];
            const PlaceBlock& block = level.blocks[block_of(child.place)];
            const std::size_t lane = lane_of(child.place);
            const BlockRows& directions = child.kind == Child::Kind::refracted
                ? refractions_[block_of(child.place)].direction
                : block.mirrored;
            set_ray(
                level.child_rays[i],
                block,
                lane,
                level.places[child.place].face,
                vector_at(directions, lane));
        }
    });
}

void GenerationTracer::add_children(const Level& level, std::span<Color> colors) const {
    // A place has at most one child of each kind, and what mirrors is added first.
    const std::size_t mirrored = level.mirrored_children;
    for_each_range(mirrored, rays_of_range, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            add_child(level, i, colors);
    });
    for_each_range(
        level.children.size() - mirrored, rays_of_range, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                add_child(level, mirrored + i, colors);
        });
}

void GenerationTracer::add_child(
    const Level& level, std::size_t number, std::span<Color> colors) const {
    const Child& child = level.children[number];
    const Place& place = level.places[child.place];
    Color& color = colors[place.ray];
    if (child.kind != Child::Kind::refracted)
        color += place.look->material->rab * level.child_colors[number];
    if (child.kind != Child::Kind::mirrored)
        color += place.look->material->tab * level.child_colors[number];
    if (level.terms != nullptr)
        add_child_terms(level, number);
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
