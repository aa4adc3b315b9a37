// SPDX-License-Identifier: Apache-2.0
#include "vera/shade/place_blocks.h"

#include "vera/scene/crossings.h"

#include <cstddef>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vera/shade/place_blocks.cpp"
#include <hwy/foreach_target.h>
// Behind the line above, which includes this file once for each instruction set.
#include "vera/shade/block_lanes-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Below, a function of lighting.h is written with the same operations in the same order for as many
// lanes as fit into a register, from `lane` on.

/// Stores the unit vectors; returns the lanes where it has stored the vectors as they are.
HWY_INLINE BlockLanes store_normalized(const Vec3s& a, BlockRows& result, std::size_t lane) {
    const Mask usual = has_usual_length(largest_component(a));
    store(chosen(usual, a / hn::Sqrt(dot(a, a)), a), result, lane);
    return bits(hn::Not(usual), lane);
}

inline void normalize(BlockRows& values, BlockLanes lanes) {
    for_each_lane(
        lanes, [&](std::size_t lane) { put(values, lane, normalized(vector_at(values, lane))); });
}

void turn_to_viewer_kernel(PlaceBlock* blocks, std::size_t count) {
    for (PlaceBlock* block = blocks; block != blocks + count; ++block) {
        BlockLanes unusual = 0;
        block->from_outside = 0;
        for (std::size_t lane = 0; lane < block_size; lane += hn::Lanes(Doubles())) {
            const Vec3s to_viewer = rows(block->to_viewer, lane);
            const Vec3s face_normal = rows(block->geometric_normal, lane);
            const Mask from_outside = hn::Ge(dot(to_viewer, face_normal), all(0));
            const Vec turn = hn::IfThenElse(from_outside, all(1), all(-1));
            store(turn * face_normal, block->geometric_normal, lane);
            block->from_outside |= bits(from_outside, lane);

            const Vec3s shading_normal = rows(block->normal, lane);
            const Vec cosine = dot(to_viewer, shading_normal);
            const Vec cos_viewer = hn::Abs(cosine);
            const Vec3s normal =
                hn::IfThenElse(hn::Lt(cosine, all(0)), all(-1), all(1)) * shading_normal;
            store(normal, block->normal, lane);
            store(cos_viewer, block->cos_viewer, lane);
            unusual |= store_normalized(
                hn::Mul(all(2), cos_viewer) * normal - to_viewer, block->mirrored, lane);

            const Vec size = largest_component(rows(block->point, lane));
            store(hn::Add(size, row(block->point_error, lane)), block->point_size, lane);
            const Vec3s black = {all(0), all(0), all(0)};
            store(black, block->diffuse, lane);
            store(black, block->highlight, lane);
        }
        normalize(block->mirrored, unusual & block->lanes);
    }
}

/// What all places have in common as to a light.
struct LightLanes {
    Vec3s position;
    Vec3s color;
    Vec intensity;
    bool falls_off;
};

HWY_INLINE Vec highlight_factors(Vec x, Vec spc) {
    const Mask shines = hn::And(hn::Lt(spc, all(1)), hn::Ge(x, spc));
    if (hn::AllFalse(Doubles(), shines))
        return all(0);
    const Vec width = hn::Sub(all(1), spc);
    const Vec factor =
        hn::Div(hn::Mul(hn::Sub(x, spc), hn::Sub(hn::Add(x, spc), all(2))), hn::Mul(width, width));
    return hn::IfThenElseZero(shines, factor);
}

/// The lanes from `lane` on; returns those that the light may reach but whose distance is unusual.
HWY_INLINE BlockLanes
light_part(const PlaceBlock& block, const LightLanes& light, std::size_t lane, LightBlock& result) {
    const Vec3s to_light = light.position - rows(block.point, lane);
    const Vec3s normal = rows(block.normal, lane);
    const Vec across = dot(to_light, normal);
    const Vec largest = largest_component(to_light);
    // As is_lit_from().
    const Vec rounding =
        hn::Add(hn::Mul(all(2), row(block.point_error, lane)), hn::Mul(all(0x1p-48), largest));
    const Mask in_front = hn::And(
        hn::Gt(across, all(0)),
        hn::Gt(dot(to_light, rows(block.geometric_normal, lane)), rounding));
    if (hn::AllFalse(Doubles(), in_front))
        return 0;

    const Mask usual = has_usual_length(largest);
    const Vec distance = hn::Sqrt(dot(to_light, to_light));
    const Vec3s light_direction = to_light / distance;
    const Vec strength =
        light.falls_off ? hn::Div(hn::Div(light.intensity, distance), distance) : light.intensity;
    const Vec3s intensity = strength * light.color;

    const Vec cos_light = dot(light_direction, normal);
    const Vec cos_viewer = dot(light_direction, rows(block.to_viewer, lane));
    const Vec cos_ahead = hn::IfThenElseZero(hn::Gt(cos_viewer, all(0)), cos_viewer);
    const Vec factor =
        highlight_factors(dot(light_direction, rows(block.mirrored, lane)), row(block.spc, lane));
    const Vec squared = hn::Mul(factor, factor);
    Mask gives_nothing = hn::Eq(all(0), all(0));
    const Vec channels[3] = {intensity.x, intensity.y, intensity.z};
    for (std::size_t channel = 0; channel < 3; ++channel) {
        const Vec reflected = hn::Add(
            hn::Mul(cos_light, row(block.drf[channel], lane)),
            hn::Mul(cos_ahead, row(block.arf[channel], lane)));
        const Vec diffuse = hn::Mul(reflected, channels[channel]);
        const Vec highlight = hn::Mul(squared, channels[channel]);
        store(diffuse, result.diffuse[channel], lane);
        store(highlight, result.highlight[channel], lane);
        // Not Ne(), which some instruction sets answer with no for what is not a number.
        gives_nothing =
            hn::And(gives_nothing, hn::And(hn::Eq(diffuse, all(0)), hn::Eq(highlight, all(0))));
    }

    store(to_light, result.to_light, lane);
    // coincidence_tolerance() at t = 1.
    const Vec tolerance =
        hn::Mul(all(0x1p-41), hn::Add(hn::Div(row(block.point_size, lane), largest), all(1)));
    store(hn::Sub(all(1), tolerance), result.shadow_end, lane);
    result.lit |= bits(hn::And(hn::And(in_front, usual), hn::Not(gives_nothing)), lane);
    return bits(hn::And(in_front, hn::Not(usual)), lane);
}

/// As light_part, for one lane.
inline void
light_lane(const PlaceBlock& block, const PointLight& light, std::size_t lane, LightBlock& result) {
    const LightTerms terms = unshadowed(incidence_at(block, lane), *block.materials[lane], light);
    if (is_black(terms))
        return;
    Ray ray;
    ray.origin = vector_at(block.point, lane);
    ray.origin_error = block.point_error[lane];
    ray.direction = light.position - ray.origin;
    put(result.to_light, lane, ray.direction);
    result.shadow_end[lane] = 1 - coincidence_tolerance(ray, 1);
    put(result.diffuse, lane, terms.diffuse);
    put(result.highlight, lane, terms.highlight);
    result.lit |= BlockLanes{1} << lane;
}

void light_up_kernel(
    const PlaceBlock* blocks, std::size_t count, const PointLight& light, LightBlock* results) {
    const LightLanes lanes = {
        {all(light.position.x), all(light.position.y), all(light.position.z)},
        {all(light.color.r), all(light.color.g), all(light.color.b)},
        all(light.intensity),
        light.falloff == Falloff::inverse_square};
    for (std::size_t i = 0; i < count; ++i) {
        const PlaceBlock& block = blocks[i];
        LightBlock& result = results[i];
        result.lit = 0;
        BlockLanes unusual = 0;
        for (std::size_t lane = 0; lane < block_size; lane += hn::Lanes(Doubles()))
            unusual |= light_part(block, lanes, lane, result);
        result.lit &= block.lanes;
        for_each_lane(unusual & block.lanes, [&](std::size_t lane) {
            light_lane(block, light, lane, result);
        });
    }
}

HWY_INLINE void add_channel(
    BlockRow& sum, const BlockRow& visibility, const BlockRow& light, Mask lit, std::size_t lane) {
    const Vec before = row(sum, lane);
    const Vec after = hn::Add(before, hn::Mul(row(visibility, lane), row(light, lane)));
    store(hn::IfThenElse(lit, after, before), sum, lane);
}

void add_light_kernel(PlaceBlock* blocks, std::size_t count, const LightBlock* lights) {
    for (std::size_t i = 0; i < count; ++i) {
        PlaceBlock& block = blocks[i];
        const LightBlock& light = lights[i];
        if (light.lit == 0)
            continue;
        for (std::size_t lane = 0; lane < block_size; lane += hn::Lanes(Doubles())) {
            const Mask lit = mask_of(light.lit, lane);
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const BlockRow& visibility = light.visibility[channel];
                add_channel(block.diffuse[channel], visibility, light.diffuse[channel], lit, lane);
                add_channel(
                    block.highlight[channel], visibility, light.highlight[channel], lit, lane);
            }
        }
    }
}

void reflected_light_kernel(
    const PlaceBlock* blocks, std::size_t count, Color ambient_light, BlockRows* colors) {
    const Vec ambient_lights[3] = {
        all(ambient_light.r), all(ambient_light.g), all(ambient_light.b)};
    for (std::size_t i = 0; i < count; ++i) {
        const PlaceBlock& block = blocks[i];
        for (std::size_t lane = 0; lane < block_size; lane += hn::Lanes(Doubles())) {
            const Vec cos_viewer = row(block.cos_viewer, lane);
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const Vec ambient = hn::Mul(
                    hn::Add(
                        hn::Mul(cos_viewer, row(block.drf[channel], lane)),
                        row(block.arf[channel], lane)),
                    ambient_lights[channel]);
                const Vec sum = hn::Add(
                    hn::Add(ambient, row(block.diffuse[channel], lane)),
                    row(block.highlight[channel], lane));
                store(sum, colors[i][channel], lane);
            }
        }
    }
}

void refract_kernel(const PlaceBlock* blocks, std::size_t count, RefractionBlock* results) {
    for (std::size_t i = 0; i < count; ++i) {
        const PlaceBlock& block = blocks[i];
        RefractionBlock& result = results[i];
        result.totally_reflected = 0;
        if (block.refracting == 0)
            continue;
        BlockLanes unusual = 0;
        for (std::size_t lane = 0; lane < block_size; lane += hn::Lanes(Doubles())) {
            const Vec ref = row(block.ref, lane);
            const Mask straight = hn::Eq(ref, all(1));
            const Vec ratio =
                hn::IfThenElse(mask_of(block.from_outside, lane), hn::Div(all(1), ref), ref);
            const Vec3s to_viewer = rows(block.to_viewer, lane);
            const Vec3s normal = rows(block.normal, lane);
            const Vec3s across = row(block.cos_viewer, lane) * normal - to_viewer;
            const Vec cos_squared =
                hn::Sub(all(1), hn::Mul(hn::Mul(ratio, ratio), dot(across, across)));
            const Mask total = hn::And(hn::Lt(cos_squared, all(0)), hn::Not(straight));
            result.totally_reflected |= bits(total, lane);
            const Vec3s bent = ratio * across - hn::Sqrt(cos_squared) * normal;
            unusual |= store_normalized(bent, result.direction, lane)
                & bits(hn::Not(hn::Or(straight, total)), lane);
            const Vec3s direction = rows(result.direction, lane);
            store(chosen(straight, all(-1) * to_viewer, direction), result.direction, lane);
        }
        normalize(result.direction, unusual & block.refracting);
        result.totally_reflected &= block.refracting;
    }
}

} // namespace vera::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vera {

HWY_EXPORT(turn_to_viewer_kernel);
HWY_EXPORT(light_up_kernel);
HWY_EXPORT(add_light_kernel);
HWY_EXPORT(reflected_light_kernel);
HWY_EXPORT(refract_kernel);

Incidence incidence_at(const PlaceBlock& block, std::size_t lane) {
    Incidence at;
    at.point = vector_at(block.point, lane);
    at.point_error = block.point_error[lane];
    at.to_viewer = vector_at(block.to_viewer, lane);
    at.normal = vector_at(block.normal, lane);
    at.geometric_normal = vector_at(block.geometric_normal, lane);
    at.mirrored = vector_at(block.mirrored, lane);
    at.cos_viewer = block.cos_viewer[lane];
    at.from_outside = (block.from_outside >> lane & 1U) != 0;
    return at;
}

void turn_to_viewer(std::span<PlaceBlock> blocks) {
    HWY_DYNAMIC_DISPATCH(turn_to_viewer_kernel)(blocks.data(), blocks.size());
}

void light_up(
    std::span<const PlaceBlock> blocks, const PointLight& light, std::span<LightBlock> lights) {
    HWY_DYNAMIC_DISPATCH(light_up_kernel)
    (blocks.data(), blocks.size(), light, lights.data());
}

void add_light(std::span<PlaceBlock> blocks, std::span<const LightBlock> lights) {
    HWY_DYNAMIC_DISPATCH(add_light_kernel)(blocks.data(), blocks.size(), lights.data());
}

void reflected_light(
    std::span<const PlaceBlock> blocks, Color ambient_light, std::span<BlockRows> colors) {
    HWY_DYNAMIC_DISPATCH(reflected_light_kernel)
    (blocks.data(), blocks.size(), ambient_light, colors.data());
}

void refract(std::span<const PlaceBlock> blocks, std::span<RefractionBlock> refractions) {
    HWY_DYNAMIC_DISPATCH(refract_kernel)(blocks.data(), blocks.size(), refractions.data());
}

} // namespace vera

#endif
