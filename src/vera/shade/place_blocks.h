// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/color.h"
#include "vera/math/vec3.h"
#include "vera/scene/light.h"
#include "vera/scene/material.h"
#include "vera/scene/surface.h"
#include "vera/shade/lighting.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace vera {

// The lighting formula for many places at once, as pictures are made: several places a processor
// instruction, with the instruction set that the machine has. To the bit, the results are those of
// the functions for one place in lighting.h, which say what the formula is.

constexpr std::size_t block_size = 8;

/// A set of the lanes of a block: bit i stands for lane i.
using BlockLanes = std::uint32_t;

/// Numbers, one a lane; vectors or colours, coordinate by coordinate.
using BlockRow = std::array<double, block_size>;
using BlockRows = std::array<BlockRow, 3>;

inline Vec3 vector_at(const BlockRows& rows, std::size_t lane) {
    return {rows[0][lane], rows[1][lane], rows[2][lane]};
}

inline Color color_at(const BlockRows& rows, std::size_t lane) {
    return {rows[0][lane], rows[1][lane], rows[2][lane]};
}

inline void put(BlockRows& rows, std::size_t lane, Vec3 value) {
    rows[0][lane] = value.x;
    rows[1][lane] = value.y;
    rows[2][lane] = value.z;
}

inline void put(BlockRows& rows, std::size_t lane, Color value) {
    rows[0][lane] = value.r;
    rows[1][lane] = value.g;
    rows[2][lane] = value.b;
}

/// Calls visit(lane) for each of the lanes, in order.
template <typename Visitor>
inline void for_each_lane(BlockLanes lanes, const Visitor& visit) {
    for (; lanes != 0; lanes &= lanes - 1)
        visit(static_cast<std::size_t>(std::countr_zero(lanes)));
}

/// Up to eight places on surfaces: the incidence and the material of each, and the light that has
/// come to it so far.
struct alignas(64) PlaceBlock {
    BlockLanes lanes = 0;        ///< that hold a place
    BlockLanes refracting = 0;   ///< whose material lets a ray through
    BlockLanes from_outside = 0; ///< see Incidence, as what follows
    BlockRows point = {};
    BlockRow point_error = {};
    BlockRows to_viewer = {};
    BlockRows normal = {};
    BlockRows geometric_normal = {};
    BlockRows mirrored = {};
    BlockRow cos_viewer = {};
    BlockRow point_size = {}; ///< the largest coordinate of the point, its error included

    BlockRows drf = {};
    BlockRows arf = {};
    BlockRow spc = {};
    BlockRow ref = {};
    std::array<const Material*, block_size> materials = {};

    BlockRows diffuse = {};
    BlockRows highlight = {};
};

/// What a light gives to the places of a block where nothing stands between.
struct alignas(64) LightBlock {
    BlockLanes lit = 0; ///< to which it gives anything; only their rows count
    BlockRows to_light = {};
    BlockRow shadow_end = {}; ///< t of the shadow ray from the place, 0, to the light, 1, behind
                              ///< which a surface is as near to the light as rounding can tell
    BlockRows diffuse = {};
    BlockRows highlight = {};
    BlockRows visibility = {}; ///< filled in by who asks what stands between
};

/// The directions in which rays go on into or out of the materials.
struct alignas(64) RefractionBlock {
    BlockLanes totally_reflected = 0;
    BlockRows direction = {};
};

/// The place in a lane, as the functions for one place see it.
Incidence incidence_at(const PlaceBlock& block, std::size_t lane);

/// Puts a place into a lane, without its material. turn_to_viewer() completes what is known of it.
inline void
put_surface(PlaceBlock& block, std::size_t lane, const SurfacePoint& surface, Vec3 ray_direction) {
    put(block.point, lane, surface.point);
    block.point_error[lane] = surface.point_error;
    put(block.to_viewer, lane, -ray_direction);
    put(block.normal, lane, surface.shading_normal);
    put(block.geometric_normal, lane, surface.geometric_normal);
}

/// What was put into the lane, of that material and face.
inline SurfacePoint
surface_in(const PlaceBlock& block, std::size_t lane, MaterialId material, FaceId face) {
    return {
        vector_at(block.point, lane),
        block.point_error[lane],
        vector_at(block.geometric_normal, lane),
        vector_at(block.normal, lane),
        material,
        face};
}

inline void put_material(PlaceBlock& block, std::size_t lane, const Material& material) {
    put(block.drf, lane, material.drf);
    put(block.arf, lane, material.arf);
    block.spc[lane] = material.spc;
    block.ref[lane] = material.ref;
    block.materials[lane] = &material;
}

/// incidence() of the places that were put into the blocks, to which no light has come yet.
void turn_to_viewer(std::span<PlaceBlock> blocks);

/// unshadowed() of each place of the blocks, and its shadow ray.
void light_up(
    std::span<const PlaceBlock> blocks, const PointLight& light, std::span<LightBlock> lights);

/// Adds to the light of each lit place what is visible of that one.
void add_light(std::span<PlaceBlock> blocks, std::span<const LightBlock> lights);

/// (Amb + Dif) + Spk of each place.
void reflected_light(
    std::span<const PlaceBlock> blocks, Color ambient_light, std::span<BlockRows> colors);

/// refracted() of the places whose material lets a ray through.
void refract(std::span<const PlaceBlock> blocks, std::span<RefractionBlock> refractions);

} // namespace vera
